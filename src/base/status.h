/* Status codes, diagnostics and the three macros of the code base.
 * Layer: base (includes nothing of the project). */
#ifndef SL_BASE_STATUS_H
#define SL_BASE_STATUS_H

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) || defined(__clang__)
#define SL_NODISCARD __attribute__((warn_unused_result))
#define SL_PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))
#else
#define SL_NODISCARD
#define SL_PRINTF(fmt, first)
#endif

/* Why a function failed. One cause, one status. Not converging is no failure: see the info structs. */
typedef enum sl_status {
    SL_OK = 0,
    SL_OUT_OF_MEMORY,         /* an allocation failed, or a size does not fit its type */
    SL_BAD_INPUT,             /* the data given is unusable: sl_diag says where and why */
    SL_IO,                    /* the operating system refused to read or write */
    SL_UNSUPPORTED,           /* well-formed, but this format or option cannot hold or do it */
    SL_NOT_POSITIVE_DEFINITE, /* a Cholesky pivot was not positive */
    SL_SINGULAR,              /* a system has no unique solution */
    SL_INFEASIBLE,            /* the constraints contradict one another or the topology */
    SL_CANCELLED,             /* progress returned false; the inputs are intact */
    SL_LIMIT,                 /* a limit the caller set (memory, charts, iterations of a search) was reached */
    SL_CHECK_FAILED,          /* a result failed its own check; it is not delivered */
    SL_INTERNAL               /* a bug of ours: please report */
} sl_status;

/* A short fixed name, such as "bad input". Never NULL. */
const char *sl_status_name(sl_status status);

/* What was wrong, where, and what to do about it. Zero-initialise before use; owned by the caller. */
typedef struct sl_diag {
    char file[256];   /* path as given; "" when there is none */
    int64_t line;     /* 1-based line of a text file, 0 = none */
    int64_t byte;     /* byte offset in a binary file, -1 = none */
    int64_t element;  /* index of the face, vertex, chart, ... concerned, -1 = none */
    char reason[256]; /* what is wrong, one sentence without a full stop */
    char hint[256];   /* what the user can do; "" when there is nothing */
} sl_diag;

/* An empty diagnostic. */
sl_diag sl_diag_none(void);

/* Fills reason by printf rules; keeps what stands in file, line, byte, element, hint. diag may be NULL. */
void sl_diag_reason(sl_diag *diag, const char *format, ...) SL_PRINTF(2, 3);

/* Fills hint by printf rules. diag may be NULL. */
void sl_diag_hint(sl_diag *diag, const char *format, ...) SL_PRINTF(2, 3);

/* "file:line: reason (element 17); hint" into text, always terminated. */
void sl_diag_format(const sl_diag *diag, char *text, size_t size);

/* Leaves by the one cleanup label of a function whose local `status` holds the outcome. */
#define SL_TRY(expression)                                                                                             \
    do {                                                                                                               \
        status = (expression);                                                                                         \
        if (status != SL_OK) {                                                                                         \
            goto cleanup;                                                                                              \
        }                                                                                                              \
    } while (0)

/* For errors of the programmer only, never for bad data. */
#define SL_ASSERT(condition) assert(condition)

#define SL_COUNTOF(array) (sizeof(array) / sizeof((array)[0]))

#endif
