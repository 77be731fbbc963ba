#include "bench/raster/frame_pipe.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

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

bool pipe_open(pipe *p)
{
    GLuint frame, storage[2];
    GLint linked = 0;
    if (!open_context()) {
        return false;
    }
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
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, PIPE_WIDTH, PIPE_HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, storage[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, storage[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, PIPE_WIDTH, PIPE_HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, storage[1]);
    glViewport(0, 0, PIPE_WIDTH, PIPE_HEIGHT);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.965f, 0.965f, 0.957f, 1.0f);
    return linked != 0 && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void pipe_load(pipe *p, int32_t nv, const float *packed, int32_t nt, const int32_t *tri)
{
    static const int size[3] = {3, 3, 2};
    static const uintptr_t start[3] = {0, 12, 24};
    GLuint *buffer = p->buffer;
    glDeleteBuffers(2, buffer);
    glGenBuffers(2, buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer[0]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)nv * PIPE_FLOATS * (GLsizeiptr)sizeof(float), packed, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)nt * 3 * (GLsizeiptr)sizeof(int32_t), tri, GL_STATIC_DRAW);
    for (GLuint k = 0; k < 3; k++) {
        glEnableVertexAttribArray(k);
        glVertexAttribPointer(k, size[k], GL_FLOAT, GL_FALSE, PIPE_FLOATS * (GLsizei)sizeof(float),
                              (const void *)start[k]);
    }
    p->indices = 3 * nt;
}

static void set_vector(const pipe *p, const char *name, const double v[3])
{
    glUniform3f(glGetUniformLocation(p->program, name), (float)v[0], (float)v[1], (float)v[2]);
}

bool pipe_draw(const pipe *p, const sl_camera *c, bool cull, uint8_t *rgba)
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
    glUniform4f(glGetUniformLocation(p->program, "lens"), (float)(2.0 * c->focal * PIPE_HEIGHT / PIPE_WIDTH),
                (float)(2.0 * c->focal), (float)((far + near) / (far - near)),
                (float)(-2.0 * far * near / (far - near)));
    if (cull) {
        glEnable(GL_CULL_FACE);
    } else {
        glDisable(GL_CULL_FACE);
    }
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, p->indices, GL_UNSIGNED_INT, NULL);
    glReadPixels(0, 0, PIPE_WIDTH, PIPE_HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return glGetError() == GL_NO_ERROR;
}
