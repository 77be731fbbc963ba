/* POSIX files. */
#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    BUFFER_BYTES = 1 << 18,
    FIRST_READ = 1 << 16,
    MAX_READ = 1 << 30, /* some systems refuse more in one call */
    NAME_TRIES = 1000
};

/* Fills diag with the file and what the system says of `error`. */
static void io_diag(sl_diag *diag, const char *path, const char *what, int error)
{
    if (diag == NULL) {
        return;
    }
    *diag = sl_diag_none();
    snprintf(diag->file, sizeof diag->file, "%s", path);
    char text[128];
    if (strerror_r(error, text, sizeof text) != 0) {
        snprintf(text, sizeof text, "error %d", error);
    }
    sl_diag_reason(diag, "%s: %s", what, text);
    if (error == ENOSPC || error == EDQUOT) {
        sl_diag_hint(diag, "free some space or write to another disk");
    } else if (error == EACCES || error == EPERM || error == EROFS) {
        sl_diag_hint(diag, "check the permissions of the file and its folder");
    } else if (error == ENOENT) {
        sl_diag_hint(diag, "check the spelling of the path");
    }
}

static bool is_stream(const char *path)
{
    return strcmp(path, "-") == 0;
}

static int open_retry(const char *path, int flags, mode_t mode)
{
    int fd;
    do {
        fd = open(path, flags | O_CLOEXEC, mode);
    } while (fd < 0 && errno == EINTR);
    return fd;
}

/* Reads fd to its end. `room` is a first guess of its size. */
static sl_status read_all(int fd, int64_t room, char **data, int64_t *size, const char *path, sl_diag *diag)
{
    sl_status status = SL_OK;
    char *buffer = NULL;
    int64_t capacity = 0, used = 0;
    SL_TRY(sl_reserve((void **)&buffer, &capacity, room + 1, 1));
    for (;;) {
        SL_TRY(sl_reserve((void **)&buffer, &capacity, used + 2, 1)); /* a byte to read and the final zero */
        const int64_t space = capacity - used - 1;
        const ssize_t n = read(fd, buffer + used, (size_t)(space < MAX_READ ? space : MAX_READ));
        if (n < 0 && errno != EINTR) {
            io_diag(diag, path, "cannot read", errno);
            status = SL_IO;
            goto cleanup;
        }
        if (n == 0) {
            break;
        }
        used += n > 0 ? n : 0;
    }
    buffer[used] = '\0';
    *data = buffer;
    *size = used;
    return SL_OK;
cleanup:
    sl_free(buffer);
    return status;
}

int64_t sl_file_written(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (int64_t)info.st_mtim.tv_sec * 1000000000 + info.st_mtim.tv_nsec : -1;
}

sl_status sl_file_read(const char *path, char **data, int64_t *size, sl_diag *diag)
{
    *data = NULL;
    *size = 0;
    const bool stream = is_stream(path);
    const int fd = stream ? STDIN_FILENO : open_retry(path, O_RDONLY, 0);
    struct stat info;
    if (fd < 0 || fstat(fd, &info) != 0) {
        io_diag(diag, path, "cannot open", errno);
        if (fd >= 0 && !stream) {
            close(fd);
        }
        return SL_IO;
    }
    sl_status status;
    if (S_ISDIR(info.st_mode)) {
        io_diag(diag, path, "cannot read", EISDIR);
        sl_diag_reason(diag, "this is a folder, not a file");
        sl_diag_hint(diag, "name a file in it");
        status = SL_IO;
    } else { /* a regular file's size is known, and one byte more shows its end without another growth */
        const int64_t room = S_ISREG(info.st_mode) && info.st_size > 0 ? (int64_t)info.st_size + 1 : FIRST_READ;
        status = read_all(fd, room, data, size, path, diag);
    }
    if (!stream) {
        close(fd);
    }
    return status;
}

struct sl_writer {
    int fd;
    int error; /* errno of the first failure, 0 = none */
    int64_t used;
    char *path;      /* as given, for messages */
    char *target;    /* what rename replaces, symbolic links followed */
    char *temporary; /* NULL: written in place (standard output, a device, a pipe) */
    char buffer[BUFFER_BYTES];
};

static void writer_free(sl_writer *writer)
{
    if (writer->fd >= 0 && writer->fd != STDOUT_FILENO) {
        close(writer->fd);
    }
    sl_free(writer->path);
    sl_free(writer->target);
    sl_free(writer->temporary);
    sl_free(writer);
}

/* Creates a file of an unused name in the target's folder, leaving writer->fd < 0 and errno on failure. */
static sl_status create_temporary(sl_writer *writer)
{
    const char *slash = strrchr(writer->target, '/');
    const int folder = slash != NULL ? (int)(slash - writer->target) + 1 : 0;
    const size_t room = (size_t)folder + 64;
    writer->temporary = sl_alloc((int64_t)room, 1);
    if (writer->temporary == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int k = 0; k < NAME_TRIES; k++) {
        snprintf(writer->temporary, room, "%.*s.seamlab-%ld-%d.tmp", folder, writer->target, (long)getpid(), k);
        writer->fd = open_retry(writer->temporary, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (writer->fd >= 0 || errno != EEXIST) {
            break;
        }
    }
    return SL_OK;
}

/* Opens what path stands for; errno says why when writer->fd stays below 0. */
static sl_status open_output(sl_writer *writer, const char *path)
{
    struct stat info;
    if (is_stream(path)) {
        writer->fd = STDOUT_FILENO;
        return SL_OK;
    }
    const bool exists = stat(path, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        errno = EISDIR;
        return SL_OK;
    }
    if (exists && !S_ISREG(info.st_mode)) {
        writer->fd = open_retry(path, O_WRONLY, 0);
        return SL_OK;
    }
    char *resolved = exists ? realpath(path, NULL) : NULL; /* replace what a link points to, not the link */
    const char *target = resolved != NULL ? resolved : path;
    writer->target = sl_copy(target, (int64_t)strlen(target) + 1, 1);
    free(resolved);
    if (writer->target == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const sl_status status = create_temporary(writer);
    if (writer->fd >= 0 && exists && fchmod(writer->fd, info.st_mode & 0777) != 0) {
        writer->error = errno;
    }
    return status;
}

sl_status sl_writer_create(const char *path, sl_writer **out, sl_diag *diag)
{
    *out = NULL;
    sl_status status = SL_OUT_OF_MEMORY;
    sl_writer *writer = sl_alloc(1, sizeof *writer);
    if (writer == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    writer->fd = -1;
    writer->error = 0;
    writer->used = 0;
    writer->target = writer->temporary = NULL;
    writer->path = sl_copy(path, (int64_t)strlen(path) + 1, 1);
    if (writer->path != NULL) {
        status = open_output(writer, path);
    }
    if (status == SL_OK && writer->fd < 0) {
        io_diag(diag, path, "cannot write", errno);
        status = SL_IO;
    }
    if (status != SL_OK) {
        writer_free(writer);
        return status;
    }
    *out = writer;
    return SL_OK;
}

static void write_out(sl_writer *writer, const char *data, int64_t size)
{
    while (size > 0 && writer->error == 0) {
        const ssize_t n = write(writer->fd, data, (size_t)(size < MAX_READ ? size : MAX_READ));
        if (n < 0) {
            writer->error = errno != EINTR ? errno : 0;
            continue;
        }
        data += n;
        size -= n;
    }
}

static void flush(sl_writer *writer)
{
    write_out(writer, writer->buffer, writer->used);
    writer->used = 0;
}

void sl_writer_bytes(sl_writer *writer, const void *data, int64_t size)
{
    SL_ASSERT(size >= 0);
    if (size > BUFFER_BYTES - writer->used) {
        flush(writer);
    }
    if (size > BUFFER_BYTES) {
        write_out(writer, data, size);
    } else if (size > 0) {
        memcpy(writer->buffer + writer->used, data, (size_t)size);
        writer->used += size;
    }
}

void sl_writer_text(sl_writer *writer, const char *text)
{
    sl_writer_bytes(writer, text, (int64_t)strlen(text));
}

void sl_writer_int(sl_writer *writer, int64_t value)
{
    char text[24];
    char *p = text + sizeof text;
    uint64_t left = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    do {
        *--p = (char)('0' + left % 10);
        left /= 10;
    } while (left > 0);
    if (value < 0) {
        *--p = '-';
    }
    sl_writer_bytes(writer, p, text + sizeof text - p);
}

void sl_writer_double(sl_writer *writer, double value)
{
    char text[SL_DOUBLE_TEXT];
    const int32_t length = sl_format_double(value, text);
    sl_writer_bytes(writer, text, length);
}

void sl_writer_format(sl_writer *writer, const char *format, ...)
{
    char small[512];
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    const int n = vsnprintf(small, sizeof small, format, args);
    va_end(args);
    char *large = n >= (int)sizeof small ? sl_alloc((int64_t)n + 1, 1) : NULL;
    if (n < 0 || (n >= (int)sizeof small && large == NULL)) {
        writer->error = writer->error != 0 ? writer->error : ENOMEM;
    } else if (large != NULL) {
        vsnprintf(large, (size_t)n + 1, format, again);
        sl_writer_bytes(writer, large, n);
    } else {
        sl_writer_bytes(writer, small, n);
    }
    va_end(again);
    sl_free(large);
}

/* Makes the renaming itself durable. Best effort: some file systems cannot, and the file is whole either way. */
static void sync_folder(const char *target)
{
    const char *slash = strrchr(target, '/');
    char *folder = sl_copy(slash != NULL ? target : ".", slash != NULL ? slash - target + 1 : 2, 1);
    if (folder == NULL) {
        return;
    }
    if (slash != NULL) {
        folder[slash > target ? slash - target : 0] = '\0';
    }
    const int fd = open_retry(folder[0] != '\0' ? folder : "/", O_RDONLY | O_DIRECTORY, 0);
    if (fd >= 0) {
        (void)fsync(fd);
        close(fd);
    }
    sl_free(folder);
}

sl_status sl_writer_commit(sl_writer *writer, sl_diag *diag)
{
    flush(writer);
    if (writer->temporary != NULL) {
        if (writer->error == 0 && fsync(writer->fd) != 0) {
            writer->error = errno;
        }
        if (close(writer->fd) != 0 && writer->error == 0) {
            writer->error = errno;
        }
        writer->fd = -1;
        if (writer->error == 0 && rename(writer->temporary, writer->target) != 0) {
            writer->error = errno;
        }
        if (writer->error != 0) {
            unlink(writer->temporary);
        } else {
            sync_folder(writer->target);
        }
    }
    const int error = writer->error;
    if (error != 0) {
        io_diag(diag, writer->path, "cannot write", error);
    }
    writer_free(writer);
    return error == 0 ? SL_OK : SL_IO;
}

void sl_writer_abandon(sl_writer *writer)
{
    if (writer == NULL) {
        return;
    }
    if (writer->temporary != NULL) {
        unlink(writer->temporary);
    }
    writer_free(writer);
}
