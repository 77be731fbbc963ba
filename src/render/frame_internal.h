/* What the files of the frame share.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_INTERNAL_H
#define SL_RENDER_FRAME_INTERNAL_H

#include "draw/screen.h"
#include "render/frame.h"

enum {
    SL_FRAME_BAND = 32, /* rows */
    SL_FRAME_PAD = 8,   /* words at the end of a row that kernels may fill */
    SL_FRAME_LINE = 16, /* words of a cache line */
    SL_FRAME_LAYERS = 8,
    SL_FRAME_FAR = INT32_MIN, /* x of a vertex that is not on the picture's plane; y says why: */
    SL_FRAME_UNUSABLE = 0,    /* not finite, or too far beside the picture */
    SL_FRAME_BEHIND = 1,      /* behind the near plane */
    SL_FRAME_SMALL = 1 << 14, /* 1/256 pixel: sides for which 32 bits suffice */
    SL_FRAME_CHUNK = 1 << 14, /* triangles */
};

/* 1/256 pixel: products of two fit 64 bits. */
#define SL_FRAME_FARTHEST 0x1p28

/* A vertex on the picture: 1/256 pixel, relative to pixel centres. Kernels read the first and the last four words. */
typedef struct sl_frame_vertex {
    float key; /* 0 near to 1 far, linear on the picture */
    int32_t x, y;
    float weight; /* 1 / depth; 1 where sight is parallel */
    float cosine; /* of the normal to the light */
} sl_frame_vertex;

/* First and last band of a triangle. */
typedef struct sl_frame_span {
    uint16_t first, last;
} sl_frame_span;

typedef struct sl_frame_lines {
    int32_t count, *pair;
    sl_frame_span *span; /* bands of the last drawing; first > last: none */
    uint8_t rgb[3];
    double width;
} sl_frame_lines;

/* The inner loops, of which there are several that give the same bytes. */
typedef struct sl_frame_kernels {
    const char *name;
    /* Least and greatest depth of the vertices [begin, end); what is not finite is left out. */
    void (*range)(const sl_frame *frame, int64_t begin, int64_t end, double *nearest, double *farthest);
    /* sl_frame_snap of those vertices, and their cosines. */
    void (*project)(const sl_frame *frame, int64_t begin, int64_t end);
    /* Lists those of the triangles [begin, end) that may show, ascending, with their bands; returns how many. One entry
     * more may be written to. */
    int32_t (*keep)(const sl_frame *frame, int32_t begin, int32_t end, int32_t *kept, sl_frame_span *span);
    /* Fills the visibility buffer of rows [row, row_end) with the triangles of the band. */
    void (*raster)(const sl_frame *frame, int32_t band, int32_t row, int32_t row_end);
    /* Colours those rows. */
    void (*shade)(const sl_frame *frame, int32_t band, int32_t row, int32_t row_end, uint8_t *rgba);
} sl_frame_kernels;

struct sl_frame {
    int32_t nv, nt;
    double *xyz;
    float *normal; /* 3 nv, unit or 0 */
    int32_t *tri;
    float *uv;       /* 6 nt or NULL */
    uint32_t *color; /* nt, bytes as in the picture, opaque */
    sl_frame_lines lines[SL_FRAME_LAYERS];
    const sl_frame_kernels *kernels;
    /* of the last drawing */
    sl_camera camera;
    sl_frame_style style;
    int32_t width, height, stride, bands;
    void *buffers;
    int64_t words;           /* room in depth and seen */
    float *depth;            /* keys, 2 where nothing is; rows `stride` apart */
    int32_t *seen;           /* place of the triangle in the band's list, -1 = none */
    sl_frame_vertex *vertex; /* nv */
    int32_t *kept;           /* SL_FRAME_CHUNK + 1 a chunk: triangles that may show */
    sl_frame_span *span;     /* theirs */
    int32_t *kept_count;     /* a chunk */
    int64_t *place;          /* bands x chunks: where each chunk's triangles of a band stand */
    int64_t places;          /* room */
    int64_t *band_first;     /* bands + 1 */
    int64_t band_room;
    int32_t *banded, *slot; /* slot: the kernels' own, one for each entry of banded, of any value */
    int64_t banded_room;
    double key_offset, key_scale;
    double light[3]; /* towards the light, scene space */
};

/* The fastest kernels of this machine, or all of them: k = 0, 1, ...; NULL after the last. */
const sl_frame_kernels *sl_frame_kernels_best(void);
const sl_frame_kernels *sl_frame_kernels_at(int32_t k);

extern const sl_frame_kernels sl_frame_kernels_portable, sl_frame_kernels_sse2, sl_frame_kernels_avx2;

/* Projects the vertices and sorts the triangles into bands. */
SL_NODISCARD sl_status sl_frame_project(sl_frame *frame, const sl_context *context);

/* On the picture? Otherwise vertex->x = SL_FRAME_FAR. cosine is left alone. */
void sl_frame_snap(const sl_frame *frame, const double eye[3], sl_frame_vertex *vertex);

/* The triangles that are too large for 32 bits or have a corner off the picture, one by one: bands (false: nothing is
 * to be seen), and rows. */
bool sl_frame_keep_odd(const sl_frame *frame, int32_t t, sl_frame_span *span);
void sl_frame_raster_odd(const sl_frame *frame, int32_t t, int32_t place, int32_t row, int32_t row_end);

/* Colour of a pixel of a triangle with a corner off the picture. */
uint32_t sl_frame_look_odd(const sl_frame *frame, int32_t t, int32_t x, int32_t y);

/* Cosine of a facet to the light. */
float sl_frame_facet_cosine(const sl_frame *frame, int32_t t);

/* Finds the bands of all lines. */
void sl_frame_span_lines(sl_frame *frame, const sl_context *context);

/* Lays the band's lines over rows [row, row_end). All rows must have been filled. */
void sl_frame_draw_lines(const sl_frame *frame, int32_t band, int32_t row, int32_t row_end, uint8_t *rgba);

/* Triangle seen at a pixel, -1 = none. */
static inline int32_t sl_frame_triangle(const sl_frame *frame, int32_t x, int32_t y)
{
    const int32_t place = frame->seen[(int64_t)y * frame->stride + x];
    return place < 0 ? -1 : frame->banded[frame->band_first[y / SL_FRAME_BAND] + place];
}

/* Barycentrics of a pixel's centre, true in space. */
void sl_frame_barycentrics(const sl_frame *frame, int32_t t, double x, double y, double bary[3]);

static inline bool sl_frame_is_off(const sl_frame *frame, int32_t t)
{
    const int32_t *v = frame->tri + 3 * (int64_t)t;
    return frame->vertex[v[0]].x == SL_FRAME_FAR || frame->vertex[v[1]].x == SL_FRAME_FAR ||
           frame->vertex[v[2]].x == SL_FRAME_FAR;
}

#endif
