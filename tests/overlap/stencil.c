#define _POSIX_C_SOURCE 200809L
#include "overlap/stencil.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#ifndef GL_STENCIL_INDEX_OES
#define GL_STENCIL_INDEX_OES 0x1901 /* GL_NV_read_stencil reads what OES_texture_stencil8 names */
#endif

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct test_stencil {
    EGLDisplay display;
    EGLContext context;
    GLuint program, frame, storage, vertices, indices;
    int32_t width, height;
    char name[160];
};

static const char vertex_source[] = "#version 300 es\n"
                                    "in vec2 uv;\n"
                                    "uniform float part;\n"
                                    "void main() { gl_Position = vec4(part * (2.0 * uv - 1.0), 0.0, 1.0); }\n";
static const char fragment_source[] = "#version 300 es\n"
                                      "precision mediump float;\n"
                                      "void main() { }\n";

static bool make_context(test_stencil *s)
{
    static const EGLint config_wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    static const EGLint context_wish[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLConfig config;
    EGLint count = 0, major, minor;
    s->display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (s->display == EGL_NO_DISPLAY || !eglInitialize(s->display, &major, &minor) || !eglBindAPI(EGL_OPENGL_ES_API) ||
        !eglChooseConfig(s->display, config_wish, &config, 1, &count) || count < 1) {
        return false;
    }
    s->context = eglCreateContext(s->display, config, EGL_NO_CONTEXT, context_wish);
    return s->context != EGL_NO_CONTEXT && eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, s->context);
}

static bool driver_will_do(test_stencil *s)
{
    const char *renderer = (const char *)glGetString(GL_RENDERER), *version = (const char *)glGetString(GL_VERSION);
    const char *extensions = (const char *)glGetString(GL_EXTENSIONS);
    if (renderer == NULL || version == NULL || extensions == NULL) {
        return false;
    }
    snprintf(s->name, sizeof s->name, "%s, %s", renderer, version);
    return strstr(renderer, "llvmpipe") != NULL && strstr(extensions, "GL_NV_read_stencil") != NULL;
}

static GLuint compile(GLenum kind, const char *source)
{
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    return shader;
}

static bool make_program(test_stencil *s)
{
    GLint linked = 0;
    s->program = glCreateProgram();
    glAttachShader(s->program, compile(GL_VERTEX_SHADER, vertex_source));
    glAttachShader(s->program, compile(GL_FRAGMENT_SHADER, fragment_source));
    glBindAttribLocation(s->program, 0, "uv");
    glLinkProgram(s->program);
    glGetProgramiv(s->program, GL_LINK_STATUS, &linked);
    glUseProgram(s->program);
    return linked != 0;
}

static bool make_target(test_stencil *s)
{
    static const GLenum none = GL_NONE;
    glGenFramebuffers(1, &s->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, s->frame);
    glGenRenderbuffers(1, &s->storage);
    glBindRenderbuffer(GL_RENDERBUFFER, s->storage);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_STENCIL_INDEX8, s->width, s->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_STENCIL_ATTACHMENT, GL_RENDERBUFFER, s->storage);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glViewport(0, 0, s->width, s->height);
    glDisable(GL_CULL_FACE);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    glGenBuffers(1, &s->vertices);
    glGenBuffers(1, &s->indices);
    glEnableVertexAttribArray(0);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR;
}

test_stencil *test_stencil_create(int32_t width, int32_t height, int threads)
{
    char number[16];
    snprintf(number, sizeof number, "%d", threads);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", number, 1);
    test_stencil *s = calloc(1, sizeof *s);
    if (s == NULL) {
        return NULL;
    }
    s->width = width;
    s->height = height;
    s->context = EGL_NO_CONTEXT;
    if (!make_context(s) || !driver_will_do(s) || !make_program(s) || !make_target(s)) {
        test_stencil_free(s);
        return NULL;
    }
    return test_stencil_widen(s, 0) ? s : (test_stencil_free(s), NULL);
}

bool test_stencil_widen(test_stencil *s, int doublings)
{
    const int32_t times = 1 << doublings;
    GLint most[2] = {0, 0};
    eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, s->context);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most);
    if (s->width * times > most[0] || s->height * times > most[1] ||
        (times > 1 && (s->width % 2 != 0 || s->height % 2 != 0))) {
        return false;
    }
    glUniform1f(glGetUniformLocation(s->program, "part"), 1.0f / (float)times);
    glViewport(-(times - 1) * (s->width / 2), -(times - 1) * (s->height / 2), s->width * times, s->height * times);
    return glGetError() == GL_NO_ERROR;
}

bool test_stencil_draw(test_stencil *s, int32_t nv, const float *uv, int32_t nt, const int32_t *tri, uint8_t *count)
{
    eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, s->context);
    glBindBuffer(GL_ARRAY_BUFFER, s->vertices);
    glBufferData(GL_ARRAY_BUFFER, 2 * (GLsizeiptr)nv * (GLsizeiptr)sizeof *uv, uv, GL_STREAM_DRAW);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, NULL);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s->indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, 3 * (GLsizeiptr)nt * (GLsizeiptr)sizeof *tri, tri, GL_STREAM_DRAW);
    glClearStencil(0);
    glClear(GL_STENCIL_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, 3 * nt, GL_UNSIGNED_INT, NULL);
    glReadPixels(0, 0, s->width, s->height, GL_STENCIL_INDEX_OES, GL_UNSIGNED_BYTE, count);
    return glGetError() == GL_NO_ERROR;
}

const char *test_stencil_name(const test_stencil *s)
{
    return s->name;
}

void test_stencil_free(test_stencil *s)
{
    if (s == NULL) {
        return;
    }
    if (s->context != EGL_NO_CONTEXT) {
        eglMakeCurrent(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(s->display, s->context);
    }
    free(s);
}
