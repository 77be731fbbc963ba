/* A frame drawn by OpenGL ES without a display. */
#ifndef SL_BENCH_FRAME_PIPE_H
#define SL_BENCH_FRAME_PIPE_H

#include "draw/camera.h"

#include <GLES3/gl3.h>

enum { PIPE_WIDTH = 1280, PIPE_HEIGHT = 800, PIPE_FLOATS = 8 };

typedef struct pipe {
    GLuint program, buffer[2];
    GLsizei indices;
} pipe;

/* False where there is no such thing. *p must be zero. */
bool pipe_open(pipe *p);

/* The mesh drawn from now on: PIPE_FLOATS a vertex: position, normal, UV. */
void pipe_load(pipe *p, int32_t nv, const float *packed, int32_t nt, const int32_t *tri);

/* From the camera to the pixels in memory, bottom row first. */
bool pipe_draw(const pipe *p, const sl_camera *camera, bool cull, uint8_t *rgba);

#endif
