/* Values of a PLY body: text, or binary of either byte order. */
#include "base/text.h"
#include "meshio/ply_internal.h"

#include <math.h>
#include <string.h>

int ply_type_size(ply_type type)
{
    static const int sizes[] = {[PLY_NONE] = 0,  [PLY_INT8] = 1,   [PLY_UINT8] = 1, [PLY_INT16] = 2, [PLY_UINT16] = 2,
                                [PLY_INT32] = 4, [PLY_UINT32] = 4, [PLY_FLOAT] = 4, [PLY_DOUBLE] = 8};
    return sizes[type];
}

static bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Line ends are LF, CR LF or CR. */
void ply_skip_space(ply_cursor *at)
{
    while (at->encoding == PLY_ASCII && at->p < at->end && is_space(*at->p)) {
        const bool pair = *at->p == '\r' && at->p + 1 < at->end && at->p[1] == '\n';
        at->line += (*at->p == '\n' || *at->p == '\r') && !pair;
        at->p++;
    }
}

/* Is x a number of this integer type? True for the floating types. */
static bool fits(ply_type type, double x)
{
    static const double lowest[] = {
        [PLY_INT8] = -0x1p7, [PLY_INT16] = -0x1p15, [PLY_INT32] = -0x1p31, [PLY_DOUBLE] = 0.0};
    static const double above[] = {[PLY_INT8] = 0x1p7,    [PLY_UINT8] = 0x1p8,  [PLY_INT16] = 0x1p15,
                                   [PLY_UINT16] = 0x1p16, [PLY_INT32] = 0x1p31, [PLY_UINT32] = 0x1p32};
    return type == PLY_FLOAT || type == PLY_DOUBLE || (x >= lowest[type] && x < above[type] && x == floor(x));
}

static bool read_text(ply_cursor *at, ply_type type, double *value)
{
    ply_skip_space(at);
    const char *after = sl_parse_double(at->p, at->end, value);
    if (after == at->p || (after < at->end && !is_space(*after)) || !fits(type, *value)) {
        return false;
    }
    at->p = after;
    return true;
}

static uint64_t load(const char *p, int size, bool big)
{
    uint64_t bits = 0;
    for (int k = 0; k < size; k++) {
        bits = bits << 8 | (unsigned char)p[big ? k : size - 1 - k];
    }
    return bits;
}

/* Two's complement of `size` bytes. */
static double signed_value(uint64_t bits, int size)
{
    const uint64_t sign = UINT64_C(1) << (8 * size - 1);
    return (double)bits - ((bits & sign) != 0 ? 2.0 * (double)sign : 0.0);
}

bool ply_read_value(ply_cursor *at, ply_type type, double *value)
{
    const int size = ply_type_size(type);
    if (at->encoding == PLY_ASCII) {
        return read_text(at, type, value);
    }
    if (at->end - at->p < size) {
        return false;
    }
    const uint64_t bits = load(at->p, size, at->encoding == PLY_BIG);
    const uint32_t low = (uint32_t)bits;
    float single;
    at->p += size;
    switch (type) {
    case PLY_FLOAT:
        memcpy(&single, &low, sizeof single);
        *value = (double)single;
        break;
    case PLY_DOUBLE:
        memcpy(value, &bits, sizeof *value);
        break;
    case PLY_INT8:
    case PLY_INT16:
    case PLY_INT32:
        *value = signed_value(bits, size);
        break;
    default:
        *value = (double)bits;
        break;
    }
    return true;
}

bool ply_read_count(ply_cursor *at, const ply_property *property, int64_t *count)
{
    double value = 1.0;
    if (property->count_type == PLY_NONE) {
        *count = 1;
        return true;
    }
    const char *start = at->p;
    const int size = at->encoding == PLY_ASCII ? 1 : ply_type_size(property->type);
    if (!ply_read_value(at, property->count_type, &value) || value < 0 || value > (double)((at->end - at->p) / size)) {
        at->p = start;
        return false;
    }
    *count = (int64_t)value;
    return true;
}

bool ply_skip_values(ply_cursor *at, ply_type type, int64_t count)
{
    double ignored;
    if (at->encoding != PLY_ASCII) {
        const int64_t room = (at->end - at->p) / ply_type_size(type);
        at->p += (count < room ? count : room) * ply_type_size(type);
        return count <= room;
    }
    for (int64_t k = 0; k < count; k++) {
        if (!ply_read_value(at, type, &ignored)) {
            return false;
        }
    }
    return true;
}

void ply_put(sl_writer *writer, ply_encoding encoding, ply_type type, double value)
{
    if (encoding == PLY_ASCII) {
        sl_writer_bytes(writer, " ", 1);
        sl_writer_double(writer, value);
        return;
    }
    const int size = ply_type_size(type);
    uint64_t bits;
    if (type == PLY_DOUBLE) {
        memcpy(&bits, &value, sizeof bits);
    } else if (type == PLY_FLOAT) {
        const float single = (float)value;
        uint32_t low;
        memcpy(&low, &single, sizeof low);
        bits = low;
    } else {
        bits = (uint64_t)(int64_t)value;
    }
    unsigned char bytes[8];
    for (int k = 0; k < size; k++) {
        bytes[encoding == PLY_BIG ? size - 1 - k : k] = (unsigned char)(bits >> (8 * k));
    }
    sl_writer_bytes(writer, bytes, size);
}
