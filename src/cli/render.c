/* seamlab render: pictures of any mesh, in space and in UV space. */
#include "render/render.h"
#include "base/memory.h"
#include "cli/cli.h"
#include "cli/render_scene.h"
#include "image/jpeg.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const cli_verb verb = {
    .name = "render",
    .usage = "seamlab render FILE -o OUT.png|OUT.jpg [--view uv|3d|both] [--camera VIEW] [--size WxH]\n"
             "       [--show WORDS] [options]",
    .summary = "Draws a mesh in space, in UV space, or both side by side. --show takes a list of: seams,\n"
               "checker, charts, overlap, stretch, eigenvector=K, symmetry, visibility, seamcost, constraints;\n"
               "without it seams, checker and charts. Where a sidecar stands beside a file, copies have\n"
               "their sources' colours.",
    .examples = "  seamlab render model-uv.obj -o model.png\n"
                "  seamlab render model-uv.obj -o front.png --view 3d --camera 20,10 --size 1600x1200\n"
                "  seamlab render model-uv.obj -o stretch.png --show seams,stretch\n"
                "  seamlab render model.obj -o v3.png --view 3d --show eigenvector=3\n"
                "  seamlab render model-uv.obj -o cloth.jpg --view 3d --texture cloth.png --tiles 12 --show seams\n",
    .min_files = 1,
    .max_files = 1,
};

enum { VIEW_AUTO, VIEW_UV, VIEW_3D, VIEW_BOTH, MAX_SIDE = 16384 };

typedef struct render_options {
    cli_run run;
    cli_scene_options scene;
    const char *output, *camera, *size, *words, *title;
    int32_t view, up, samples, quality;
    bool fast;
    sl_view from;
    sl_picture picture;
} render_options;

/* One word of --show, `length` characters long. */
static bool show_word(const char *word, size_t length, cli_show *show)
{
    static const char eigenvector[] = "eigenvector=";
    const struct {
        const char *name;
        bool *target;
    } words[] = {{"seams", &show->seams},           {"checker", &show->checker},   {"overlap", &show->overlap},
                 {"stretch", &show->stretch},       {"charts", &show->charts},     {"symmetry", &show->symmetry},
                 {"visibility", &show->visibility}, {"seamcost", &show->seamcost}, {"constraints", &show->constraints}};
    for (size_t k = 0; k < SL_COUNTOF(words); k++) {
        if (length == strlen(words[k].name) && strncmp(word, words[k].name, length) == 0) {
            *words[k].target = true;
            return true;
        }
    }
    if (strncmp(word, eigenvector, strlen(eigenvector)) == 0) {
        char *end;
        const long number = strtol(word + strlen(eigenvector), &end, 10);
        show->eigenvector = number >= 1 && number <= 1000 ? (int32_t)number : 0;
        return end == word + length && show->eigenvector > 0;
    }
    return false;
}

bool cli_show_parse(const char *words, cli_show *show)
{
    *show = (cli_show){0};
    for (const char *at = words; *at != '\0';) {
        const size_t length = strcspn(at, ",");
        if (!show_word(at, length, show)) {
            fprintf(stderr,
                    "seamlab render: --show does not know '%.*s'; it knows seams, checker, charts, overlap, stretch, "
                    "eigenvector=K (1 to 1000), symmetry, visibility, seamcost, constraints\n",
                    (int)length, at);
            return false;
        }
        at += length + (at[length] == ',');
    }
    const int colors =
        show->charts + show->stretch + show->symmetry + show->visibility + show->seamcost + (show->eigenvector > 0);
    if (colors > 1) {
        fprintf(
            stderr,
            "seamlab render: charts, stretch, eigenvector, symmetry, visibility and seamcost colour the same facets: "
            "--show one of them\n");
    }
    return colors <= 1;
}

bool cli_camera_parse(const char *text, sl_view *view)
{
    static const struct {
        const char *name;
        double azimuth, elevation;
    } names[] = {{"front", 0, 0},  {"right", 90, 0}, {"back", 180, 0},
                 {"left", -90, 0}, {"top", 0, 90},   {"bottom", 0, -90}};
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        if (strcmp(text, names[k].name) == 0) {
            view->azimuth = names[k].azimuth;
            view->elevation = names[k].elevation;
            view->fov = 0.0;
            return true;
        }
    }
    double number[3] = {0.0, 0.0, view->fov};
    char *end = NULL;
    int32_t count = 0;
    for (const char *at = text; count < 3; at = end + 1) {
        number[count++] = strtod(at, &end);
        if (end == at || (*end != ',' && *end != '\0')) {
            return false;
        }
        if (*end == '\0') {
            break;
        }
    }
    view->azimuth = number[0];
    view->elevation = number[1];
    view->fov = number[2];
    return count >= 2 && *end == '\0' && fabs(number[0]) <= 1e6 && fabs(number[1]) <= 90.0 && number[2] >= 0.0 &&
           number[2] <= 120.0;
}

static bool parse_size(const char *text, sl_picture *picture)
{
    char *end;
    const long width = strtol(text, &end, 10);
    if (end == text || (*end != 'x' && *end != 'X')) {
        return false;
    }
    const char *second = end + 1;
    const long height = strtol(second, &end, 10);
    if (end == second || *end != '\0' || width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE) {
        return false;
    }
    picture->width = (int32_t)width;
    picture->height = (int32_t)height;
    return true;
}

static bool is_jpeg(const char *path)
{
    return cli_has_extension(path, ".jpg") || cli_has_extension(path, ".jpeg");
}

static int usage(const char *what, const char *text)
{
    return cli_usage(verb.name, "%s: '%s'", what, text);
}

static int check_options(render_options *o)
{
    if (o->output == NULL) {
        return cli_usage(verb.name, "where to? give -o OUT.png or -o OUT.jpg");
    }
    if (strcmp(o->output, "-") != 0 && !is_jpeg(o->output) && !cli_has_extension(o->output, ".png")) {
        return usage("-o writes .png and .jpg, not", o->output);
    }
    if (o->camera != NULL && !cli_camera_parse(o->camera, &o->from)) {
        return usage("--camera is front, back, left, right, top, bottom or AZIMUTH,ELEVATION[,FOV in degrees], not",
                     o->camera);
    }
    if (o->size != NULL && !parse_size(o->size, &o->picture)) {
        return usage("--size is WIDTHxHEIGHT, each 1 to 16384, not", o->size);
    }
    if (o->words != NULL && !cli_show_parse(o->words, &o->scene.show)) {
        return CLI_USAGE;
    }
    if (o->scene.show.constraints && o->scene.constraints == NULL) {
        return cli_usage(verb.name, "--show constraints needs --constraints FILE");
    }
    o->scene.show.constraints = o->scene.constraints != NULL;
    return -1;
}

/* What was left open is decided by whether there are UVs. */
static void settle(render_options *o, bool has_uv)
{
    static const int32_t sides[4][2] = {{0, 0}, {1280, 1280}, {1280, 960}, {1920, 960}};
    if (o->view == VIEW_AUTO) {
        o->view = has_uv ? VIEW_BOTH : VIEW_3D;
    }
    if (o->size == NULL) {
        o->picture.width = sides[o->view][0];
        o->picture.height = sides[o->view][1];
    }
}

static sl_status draw(render_options *o, const cli_scene *s, sl_image **image, sl_diag *diag)
{
    o->picture.value_name = s->value_name;
    o->from.up_axis = o->up;
    switch (o->view) {
    case VIEW_UV:
        o->picture.uv_title = o->title;
        return sl_render_uv(&s->scene, &o->picture, &o->run.context, image, diag);
    case VIEW_BOTH:
        o->picture.title = o->title;
        return sl_render_pair(&s->scene, &o->from, &o->picture, &o->run.context, image, diag);
    default:
        o->picture.title = o->title;
        return sl_render_3d(&s->scene, &o->from, &o->picture, &o->run.context, image, diag);
    }
}

static int render_file(render_options *o)
{
    sl_diag diag = sl_diag_none();
    sl_image *image = NULL;
    cli_scene scene;
    sl_status status = SL_OK;
    if (o->words == NULL) {
        o->scene.charts_if_uv = true;
        o->scene.show =
            (cli_show){.seams = true, .checker = o->scene.texture == NULL, .constraints = o->scene.constraints != NULL};
    }
    const int code = cli_scene_open(&o->run, &o->scene, &scene);
    if (code != CLI_DONE) {
        cli_scene_clear(&scene);
        return code;
    }
    settle(o, scene.corner_uv != NULL);
    SL_TRY(draw(o, &scene, &image, &diag));
    status = is_jpeg(o->output) ? sl_jpeg_write(o->output, image, o->quality, true, &diag)
                                : sl_png_write(o->output, image, &diag);
cleanup:
    sl_image_free(image);
    cli_scene_clear(&scene);
    return cli_fail(&o->run, status, &diag);
}

enum { OWN = 17, ALL = OWN + CLI_COMMON_OPTIONS };

static void option_table(render_options *o, cli_option *options)
{
    cli_scene_options *s = &o->scene;
    const cli_option own[OWN] = {
        {"output", 'o', CLI_TEXT, &o->output, 0, 0, NULL, "OUT", "picture to write: .png or .jpg, - = PNG on stdout"},
        {"view", 0, CLI_CHOICE, &o->view, 0, 0, "auto|uv|3d|both", NULL, "auto (default): both where there are UVs"},
        {"camera", 0, CLI_TEXT, &o->camera, 0, 0, NULL, "VIEW",
         "front, back, left, right, top, bottom (orthographic), or AZIMUTH,ELEVATION[,FOV] in degrees (35,20,24); FOV "
         "0 = orthographic"},
        {"up", 0, CLI_CHOICE, &o->up, 0, 0, "x|y|z", NULL, "axis that points up (y)"},
        {"size", 0, CLI_TEXT, &o->size, 0, 0, NULL, "WxH", "pixels, each 1 to 16384"},
        {"show", 0, CLI_TEXT, &o->words, 0, 0, NULL, "WORDS", "what to show, separated by commas"},
        {"constraints", 0, CLI_TEXT, &s->constraints, 0, 0, NULL, "FILE",
         "edges (a line 'vertex vertex' each) drawn blue, their ends as yellow dots"},
        {"texture", 0, CLI_TEXT, &s->texture, 0, 0, NULL, "IMAGE", "a PNG or JPEG laid through the UVs"},
        {"tiles", 0, CLI_REAL, &s->tiles, 0x1p-20, 1e6, NULL, "N", "how often the texture fits into a unit of UV (1)"},
        {"checks", 0, CLI_REAL, &s->checks, 0x1p-20, 1e6, NULL, "N", "checkerboard squares a unit of UV (48)"},
        {"wire", 0, CLI_REAL, &s->wire, 0, 1, NULL, "A", "opacity of all edges as hairlines (0)"},
        {"resolution", 0, CLI_INT, &s->resolution, 1, 16384, NULL, "N",
         "texels a side by which overlap is found (4096)"},
        {"samples", 0, CLI_INT, &o->samples, 1, 4, NULL, "N", "samples a pixel and axis: 2 (default) = 4 a pixel"},
        {"no-shadows", 0, CLI_FLAG, &o->fast, 0, 0, NULL, NULL, "plain light: several times faster"},
        {"title", 0, CLI_TEXT, &o->title, 0, 0, NULL, "TEXT", "written at the top left"},
        {"quality", 0, CLI_INT, &o->quality, 1, 100, NULL, "N", "of a JPEG (90)"},
        {"back", 0, CLI_FLAG, &o->picture.back_view, 0, 0, NULL, NULL, "--view both: the model from behind, too"},
    };
    memcpy(options, own, sizeof own);
    cli_common_options(&o->run, options + OWN);
}

int cli_render(int argc, char **argv)
{
    render_options o = {.run = {.verb = verb.name},
                        .scene = {.tiles = 1.0, .checks = 48.0, .resolution = 4096},
                        .up = 1,
                        .samples = 2,
                        .quality = SL_JPEG_QUALITY,
                        .from = sl_view_default(),
                        .picture = sl_picture_default()};
    cli_option options[ALL];
    const char *files[1];
    int32_t file_count = 0;
    option_table(&o, options);
    int code = cli_parse(&verb, options, ALL, argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = check_options(&o)) >= 0 || (code = cli_begin(&o.run)) >= 0) {
        return code;
    }
    o.scene.path = files[0];
    o.picture.samples = o.samples;
    o.picture.sky_lights = o.fast ? 0 : o.picture.sky_lights;
    return cli_end(&o.run, render_file(&o));
}
