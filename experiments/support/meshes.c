#define _POSIX_C_SOURCE 200809L
#include "generators.h"
#include "support/run.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int compare_sources(const void *a, const void *b)
{
    return strcmp(((const exp_source *)a)->name, ((const exp_source *)b)->name);
}

static bool is_mesh(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot != NULL && (strcmp(dot, ".obj") == 0 || strcmp(dot, ".off") == 0 || strcmp(dot, ".ply") == 0);
}

static int32_t list_folder(const char *folder, exp_source *source, int32_t room)
{
    DIR *dir = folder != NULL ? opendir(folder) : NULL;
    struct dirent *entry;
    int32_t count = 0;
    while (dir != NULL && count < room && (entry = readdir(dir)) != NULL) {
        exp_source *s = &source[count];
        if (is_mesh(entry->d_name) && strlen(entry->d_name) < sizeof s->name &&
            snprintf(s->path, sizeof s->path, "%s/%s", folder, entry->d_name) < (int)sizeof s->path) {
            strcpy(s->name, entry->d_name);
            *strrchr(s->name, '.') = '\0';
            s->generated = false;
            count++;
        }
    }
    if (dir != NULL) {
        closedir(dir);
    }
    qsort(source, (size_t)count, sizeof *source, compare_sources);
    return count;
}

int32_t exp_list_sources(const exp_run *run, exp_source *source)
{
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        source[k] = (exp_source){.generated = true};
        snprintf(source[k].name, sizeof source[k].name, "%s", generator[k].name);
    }
    return count + list_folder(run->corpus, source + count, EXP_MAX_MESHES - count);
}

sl_status exp_mesh_load(const exp_source *source, exp_mesh *mesh, sl_diag *diag)
{
    sl_status status;
    *mesh = (exp_mesh){0};
    if (source->generated) {
        const sl_generator *generator = sl_generator_find(source->name);
        status = generator != NULL ? generator->make(1, 1, &mesh->generated) : SL_BAD_INPUT;
        if (status == SL_OK) {
            sl_generated_polygons(mesh->generated, &mesh->polygons);
        }
    } else {
        status = sl_meshfile_read(source->path, &mesh->file, diag);
        if (status == SL_OK) {
            sl_meshfile_polygons(mesh->file, &mesh->polygons);
        }
    }
    return status == SL_IO ? SL_BAD_INPUT : status;
}

void exp_mesh_clear(exp_mesh *mesh)
{
    sl_generated_free(mesh->generated);
    sl_meshfile_free(mesh->file);
    *mesh = (exp_mesh){0};
}

/* Names of meshes that are not best seen from the usual place: which axis is up, from where to look. */
static const struct {
    const char *name;
    double azimuth, elevation;
    int32_t up_axis;
} views[] = {
    {"hand", 12.0, 10.0, 1},
    {"body", 24.0, 8.0, 1},
    {"fandisk", -40.0, 28.0, 1},
    {"spot", 145.0, 12.0, 1},
};

sl_view exp_view_of(const char *name)
{
    sl_view view = sl_view_default();
    for (size_t k = 0; k < SL_COUNTOF(views); k++) {
        if (strcmp(views[k].name, name) == 0) {
            view.azimuth = views[k].azimuth;
            view.elevation = views[k].elevation;
            view.up_axis = views[k].up_axis;
        }
    }
    return view;
}
