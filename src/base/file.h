/* Files: read whole, write atomically.
 * Layer: base. */
#ifndef SL_BASE_FILE_H
#define SL_BASE_FILE_H

#include "base/status.h"

/* Reads a whole file ("-" = standard input). *data is owned by the caller (sl_free), followed by one zero byte that is
 * not counted in *size. Nothing is allocated on a header's word: the buffer grows with what was read.
 * SL_IO (missing, a folder, unreadable), SL_OUT_OF_MEMORY. diag is nullable. */
SL_NODISCARD sl_status sl_file_read(const char *path, char **data, int64_t *size, sl_diag *diag);

/* When the file was last written, in nanoseconds of the system's clock; -1: it is not there. */
int64_t sl_file_written(const char *path);

/* A file being written: a temporary beside the final name, renamed on commit. Buffered; errors are kept until commit.
 */
typedef struct sl_writer sl_writer;

/* Opens PATH's temporary ("-" = standard output, no temporary). SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_writer_create(const char *path, sl_writer **out, sl_diag *diag);

void sl_writer_bytes(sl_writer *writer, const void *data, int64_t size);
void sl_writer_text(sl_writer *writer, const char *text);
void sl_writer_int(sl_writer *writer, int64_t value);

/* Shortest decimal that reads back as exactly this double; locale-free. */
void sl_writer_double(sl_writer *writer, double value);

/* printf rules, for text and integers; use sl_writer_double for numbers with a point. */
void sl_writer_format(sl_writer *writer, const char *format, ...) SL_PRINTF(2, 3);

/* Flushes, syncs and renames into place; SL_IO if anything failed since create, and then PATH is as it was before.
 * Frees the writer in every case. */
SL_NODISCARD sl_status sl_writer_commit(sl_writer *writer, sl_diag *diag);

/* Removes the temporary and frees; PATH is untouched. NULL is a no-op. */
void sl_writer_abandon(sl_writer *writer);

#endif
