/* A frame of 1280 x 800 with depth, Gouraud light and a filtered checkerboard: ours against llvmpipe, in turns. Both
 * keep the mesh; a frame is from the new camera to the pixels in memory. CPU time of the process, the least of the
 * runs. frame [RUNS] [THREADS of llvmpipe] */
#define _POSIX_C_SOURCE 200809L
#include "render/frame.h"
#include "base/memory.h"
#include "image/jpeg.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 1280, HEIGHT = 800, FLOATS = 8 };

static const char vertex_source[] =
    "#version 300 es\n"
    "layout(location = 0) in vec3 p; layout(location = 1) in vec3 n; layout(location = 2) in vec2 t;\n"
    "uniform vec3 eye, right, up, ahead, sun; uniform vec4 lens;\n"
    "out float light; out vec2 uv;\n"
    "void main() {\n"
    "  vec3 q = p - eye; float x = dot(q, right), y = dot(q, up), z = dot(q, ahead);\n"
    "  gl_Position = vec4(lens.x * x, lens.y * y, lens.z * z + lens.w, z);\n"
    "  light = 0.34 + 0.62 * max(0.25 + 0.75 * dot(normalize(n), sun), 0.0); uv = 48.0 * t;\n"
    "}\n";
static const char fragment_source[] = "#version 300 es\n"
                                      "precision highp float;\n"
                                      "in float light; in vec2 uv; out vec4 color;\n"
                                      "vec2 wave(vec2 x) { return abs(x - 2.0 * round(0.5 * x)); }\n"
                                      "void main() {\n"
                                      "  vec2 w = max(max(abs(dFdx(uv)), abs(dFdy(uv))), 1e-4);\n"
                                      "  vec2 m = clamp((wave(uv + 0.5 * w) - wave(uv - 0.5 * w)) / w, -1.0, 1.0);\n"
                                      "  float s = 0.63 * light * (0.84 + 0.16 * m.x * m.y);\n"
                                      "  color = vec4(vec3(pow(clamp(s, 0.0, 1.0), 0.4545)), 1.0);\n"
                                      "}\n";

typedef struct torus {
    int32_t nv, nt, *tri;
    double *xyz, *uv;
    float *packed; /* FLOATS a vertex: position, normal, UV */
} torus;

typedef struct pipe {
    GLuint program;
    GLsizei indices;
} pipe;

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* A bumpy torus of n x n quads. */
static torus make_torus(int32_t n)
{
    const double turn = 6.283185307179586;
    torus m = {.nv = n * n, .nt = 2 * n * n};
    m.tri = sl_alloc(m.nt, 3 * sizeof *m.tri);
    m.xyz = sl_alloc(m.nv, 3 * sizeof *m.xyz);
    m.uv = sl_alloc(m.nt, 6 * sizeof *m.uv);
    m.packed = sl_calloc(m.nv, FLOATS * sizeof *m.packed);
    if (m.tri == NULL || m.xyz == NULL || m.uv == NULL || m.packed == NULL) {
        exit(1);
    }
    for (int32_t v = 0; v < m.nv; v++) {
        const double a = turn * (v % n) / n, b = turn * (v / n) / n;
        const double r = 0.4 + 0.05 * sin(3.0 * a + b) + 0.03 * cos(2.0 * b) + 0.02 * sin(17.0 * a) * cos(13.0 * b);
        const double p[3] = {(1.0 + r * cos(b)) * cos(a), r * sin(b), (1.0 + r * cos(b)) * sin(a)};
        const double up[3] = {cos(b) * cos(a), sin(b), cos(b) * sin(a)};
        for (int k = 0; k < 3; k++) {
            m.xyz[3 * v + k] = p[k];
            m.packed[FLOATS * v + k] = (float)p[k];
            m.packed[FLOATS * v + 3 + k] = (float)up[k];
        }
        m.packed[FLOATS * v + 6] = (float)(v % n) / (float)n;
        m.packed[FLOATS * v + 7] = (float)(v / n) / (float)n;
    }
    for (int32_t q = 0; q < m.nv; q++) {
        const int32_t right = q / n * n + (q + 1) % n, below = (q / n + 1) % n * n + q % n;
        const int32_t across = (q / n + 1) % n * n + (q + 1) % n;
        const int32_t six[6] = {q, below, across, q, across, right};
        memcpy(m.tri + 6 * q, six, sizeof six);
        for (int k = 0; k < 6; k++) {
            const bool east = k == 2 || k >= 4, south = k == 1 || k == 2 || k == 4;
            m.uv[12 * q + 2 * k] = (double)(q % n + east) / n;
            m.uv[12 * q + 2 * k + 1] = (double)(q / n + south) / n;
        }
    }
    return m;
}

static bool open_context(void)
{
    static const EGLint config_wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    static const EGLint context_wish[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLConfig config;
    EGLint count = 0, major, minor;
    const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (!eglInitialize(display, &major, &minor) || !eglBindAPI(EGL_OPENGL_ES_API) ||
        !eglChooseConfig(display, config_wish, &config, 1, &count) || count < 1) {
        return false;
    }
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wish);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

static GLuint compile(GLenum kind, const char *source)
{
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    return shader;
}

static bool open_pipe(pipe *p)
{
    GLuint frame, storage[2];
    GLint linked = 0;
    p->program = glCreateProgram();
    glAttachShader(p->program, compile(GL_VERTEX_SHADER, vertex_source));
    glAttachShader(p->program, compile(GL_FRAGMENT_SHADER, fragment_source));
    glLinkProgram(p->program);
    glGetProgramiv(p->program, GL_LINK_STATUS, &linked);
    glUseProgram(p->program);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glGenRenderbuffers(2, storage);
    glBindRenderbuffer(GL_RENDERBUFFER, storage[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, WIDTH, HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, storage[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, storage[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, WIDTH, HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, storage[1]);
    glViewport(0, 0, WIDTH, HEIGHT);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.965f, 0.965f, 0.957f, 1.0f);
    return linked != 0 && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

static void load_mesh(pipe *p, const torus *m)
{
    static const int size[3] = {3, 3, 2};
    static const uintptr_t start[3] = {0, 12, 24};
    GLuint buffer[2];
    glGenBuffers(2, buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer[0]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)m->nv * FLOATS * (GLsizeiptr)sizeof(float), m->packed, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)m->nt * 3 * (GLsizeiptr)sizeof(int32_t), m->tri, GL_STATIC_DRAW);
    for (GLuint k = 0; k < 3; k++) {
        glEnableVertexAttribArray(k);
        glVertexAttribPointer(k, size[k], GL_FLOAT, GL_FALSE, FLOATS * (GLsizei)sizeof(float), (const void *)start[k]);
    }
    p->indices = 3 * m->nt;
}

static void set_vector(const pipe *p, const char *name, const double v[3])
{
    glUniform3f(glGetUniformLocation(p->program, name), (float)v[0], (float)v[1], (float)v[2]);
}

static bool pipe_draw(const pipe *p, const sl_camera *c, bool cull, uint8_t *rgba)
{
    const double far = 20.0, near = 0.5;
    double sun[3];
    for (int k = 0; k < 3; k++) {
        sun[k] = -0.42 * c->right[k] + 0.62 * c->up[k] - 0.66 * c->forward[k];
    }
    set_vector(p, "eye", c->eye);
    set_vector(p, "right", c->right);
    set_vector(p, "up", c->up);
    set_vector(p, "ahead", c->forward);
    set_vector(p, "sun", sun);
    glUniform4f(glGetUniformLocation(p->program, "lens"), (float)(2.0 * c->focal * HEIGHT / WIDTH),
                (float)(2.0 * c->focal), (float)((far + near) / (far - near)),
                (float)(-2.0 * far * near / (far - near)));
    if (cull) {
        glEnable(GL_CULL_FACE);
    } else {
        glDisable(GL_CULL_FACE);
    }
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, p->indices, GL_UNSIGNED_INT, NULL);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return glGetError() == GL_NO_ERROR;
}

/* Share of the pixels that are background in one and not in the other: are the same things drawn? */
static double unlike(const uint8_t *ours, const uint8_t *theirs)
{
    int64_t count = 0;
    for (int32_t y = 0; y < HEIGHT; y++) {
        for (int32_t x = 0; x < WIDTH; x++) {
            const uint8_t *a = ours + 4 * (y * WIDTH + x), *b = theirs + 4 * ((HEIGHT - 1 - y) * WIDTH + x);
            count += (a[0] == 246) != (b[0] == 246);
        }
    }
    return (double)count / ((double)WIDTH * HEIGHT);
}

static int race(pipe *p, int32_t n, int runs)
{
    const torus m = make_torus(n);
    const sl_frame_def def = {m.nv, m.nt, m.xyz, m.tri, m.uv, NULL};
    sl_frame *frame = NULL;
    sl_image *ours = NULL, *theirs = NULL;
    load_mesh(p, &m);
    if (sl_frame_create(&def, &frame) != SL_OK || sl_image_create(WIDTH, HEIGHT, 4, &ours) != SL_OK ||
        sl_image_create(WIDTH, HEIGHT, 4, &theirs) != SL_OK) {
        return 1;
    }
    for (int cull = 0; cull < 2; cull++) {
        double least[3] = {1e9, 1e9, 1e9};
        for (int k = 0; k < runs; k++) {
            sl_view view = sl_view_default();
            sl_camera camera;
            sl_frame_style style = sl_frame_style_default();
            uint8_t *jpeg = NULL;
            int64_t size = 0;
            view.azimuth += 0.01 * k;
            style.cull = cull != 0;
            if (sl_camera_frame(&view, (double)WIDTH / HEIGHT, m.nv, NULL, m.xyz, &camera) != SL_OK) {
                return 1;
            }
            const double t0 = cpu_ms();
            const bool drawn = pipe_draw(p, &camera, style.cull, theirs->pixels);
            const double t1 = cpu_ms();
            const sl_status status = sl_frame_draw(frame, &camera, &style, WIDTH, HEIGHT, NULL, ours->pixels);
            const double t2 = cpu_ms();
            if (!drawn || status != SL_OK || sl_jpeg_encode(ours, SL_JPEG_QUALITY, false, &jpeg, &size) != SL_OK) {
                return 1;
            }
            const double t3 = cpu_ms(), took[3] = {t1 - t0, t2 - t1, t3 - t2};
            for (int i = 0; i < 3; i++) {
                least[i] = took[i] < least[i] ? took[i] : least[i];
            }
            sl_free(jpeg);
        }
        printf("%8d  %-6s  %9.2f  %9.2f  %6.2f  %9.2f  %10.5f\n", m.nt, cull != 0 ? "yes" : "no", least[0], least[1],
               least[0] / least[1], least[2], unlike(ours->pixels, theirs->pixels));
    }
    sl_image_free(ours);
    sl_image_free(theirs);
    sl_frame_free(frame);
    sl_free(m.tri);
    sl_free(m.xyz);
    sl_free(m.uv);
    sl_free(m.packed);
    return 0;
}

int main(int argc, char **argv)
{
    static const int32_t sides[] = {186, 373, 745};
    pipe p;
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", argc > 2 ? argv[2] : "0", 1);
    if (!open_context() || !open_pipe(&p)) {
        fprintf(stderr, "no OpenGL ES 3 without a display here\n");
        return 77;
    }
    printf("%s\ntriangles culled   llvmpipe       ours   ratio       jpeg  silhouette\n",
           (const char *)glGetString(GL_RENDERER));
    for (size_t k = 0; k < SL_COUNTOF(sides); k++) {
        if (race(&p, sides[k], argc > 1 ? atoi(argv[1]) : 15) != 0) {
            return 1;
        }
    }
    return 0;
}
