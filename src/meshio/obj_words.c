#include "meshio/obj_internal.h"

#include <string.h>

void obj_skip_statement(obj_cursor *at)
{
    bool comment = false;
    while (at->p < at->end && !obj_is_newline(*at->p)) {
        comment = comment || *at->p == '#';
        if (!comment && obj_at_continuation(at)) {
            at->p++;
            obj_skip_newline(at);
        } else {
            at->p++;
        }
    }
}

static obj_word classify(const char *word, size_t n)
{
    static const struct {
        const char *text;
        obj_word word;
    } words[] = {{"v", OBJ_VERTEX}, {"vt", OBJ_TEXTURE}, {"vn", OBJ_NORMAL},   {"f", OBJ_FACE},
                 {"fo", OBJ_FACE},  {"l", OBJ_LINE},     {"p", OBJ_POINT},     {"o", OBJ_NAME},
                 {"g", OBJ_NAME},   {"s", OBJ_NAME},     {"usemtl", OBJ_NAME}, {"mtllib", OBJ_NAME}};
    for (size_t k = 0; k < SL_COUNTOF(words); k++) {
        if (strlen(words[k].text) == n && memcmp(word, words[k].text, n) == 0) {
            return words[k].word;
        }
    }
    return OBJ_OTHER;
}

obj_word obj_read_word(obj_cursor *at)
{
    obj_skip_blank(at);
    const char *word = at->p;
    while (!obj_at_gap(at)) {
        at->p++;
    }
    const size_t n = (size_t)(at->p - word);
    obj_skip_blank(at);
    if (n == 0) {
        return OBJ_EMPTY;
    }
    if (n == 1 && *word == 'v') { /* the two most frequent words first */
        return OBJ_VERTEX;
    }
    return n == 1 && *word == 'f' ? OBJ_FACE : classify(word, n);
}
