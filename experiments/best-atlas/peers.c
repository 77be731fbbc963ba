#include "atlases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 256, NAME = 32 };

/* One row of a table of atlases, as far as it is shown. */
typedef struct peer {
    char tool[NAME], mesh[NAME];
    double charts, seam, angle, l2, fill, seconds;
} peer;

typedef struct peer_table {
    int32_t count;
    peer row[MOST_ROWS];
} peer_table;

static const char *const recorded = EXPERIMENT_FOLDER "/../../reports/reference/atlases-ours.csv";
static const char *const own_claims = EXPERIMENT_FOLDER "/peers.csv";
static const char *const compared = "uvatlas"; /* whose L2 is the target */
static const double largest_angle = 1.2;

/* Lines that do not read as a row, such as the heading, are passed over. */
static sl_status read_table(const char *path, peer_table *table, sl_diag *diag)
{
    char *data = NULL;
    int64_t size = 0;
    const sl_status status = sl_file_read(path, &data, &size, diag);
    for (char *line = data; status == SL_OK && line != NULL && *line != '\0' && table->count < MOST_ROWS;) {
        peer *p = &table->row[table->count];
        table->count +=
            sscanf(line,
                   "%31[^,],%31[^,],%*d,%lf,%*f,%*d,%lf,%*d,%lf,%*d,%*d,%*f,%*f,%lf,%*f,%*f,%lf,%*f,%*f,%*f,"
                   "%lf",
                   p->tool, p->mesh, &p->seconds, &p->charts, &p->seam, &p->angle, &p->l2, &p->fill) == 8;
        line = strchr(line, '\n');
        line = line != NULL ? line + 1 : NULL;
    }
    sl_free(data);
    return status;
}

/* What only holds where the peers are at hand. */
static sl_status add_claims(exp_claims *claims, sl_diag *diag)
{
    exp_claims more = {0};
    int64_t capacity = claims->count;
    sl_status status = SL_OK;
    SL_TRY(exp_claims_read(own_claims, &more, diag));
    SL_TRY(sl_reserve((void **)&claims->claim, &capacity, (int64_t)claims->count + more.count, sizeof *more.claim));
    memcpy(claims->claim + claims->count, more.claim, (size_t)more.count * sizeof *more.claim);
    claims->count += more.count;
cleanup:
    exp_claims_clear(&more);
    return status;
}

static bool is_there(const char *path, int length)
{
    FILE *file = length > 0 && length < EXP_PATH ? fopen(path, "r") : NULL;
    if (file != NULL) {
        fclose(file);
    }
    return file != NULL;
}

/* The peers' table: named by SEAMLAB_PEERS, or in the corpus folder, or in a folder `peers` beside it. */
static bool find_table(const exp_run *run, char path[EXP_PATH])
{
    const char *named = getenv("SEAMLAB_PEERS");
    if (run->corpus == NULL || run->quick) {
        return false; /* no meshes to compare on */
    }
    return (named != NULL && is_there(path, snprintf(path, EXP_PATH, "%s", named))) ||
           is_there(path, snprintf(path, EXP_PATH, "%s/atlases.csv", run->corpus)) ||
           is_there(path, snprintf(path, EXP_PATH, "%s/../peers/atlases.csv", run->corpus));
}

static void show_row(exp_page *page, const peer *p)
{
    exp_page_row_begin(page, false);
    exp_page_cell(page, "%s", p->mesh);
    exp_page_cell(page, "%s", p->tool);
    exp_page_cell(page, "%.0f", p->charts);
    number_cells(page, p->seam, p->l2, p->angle, p->fill);
    exp_page_time(page, "%.2f", p->seconds);
    exp_page_row_end(page);
}

/* Ours at that tool's L2. */
static sl_status reach(exp_run *run, const exp_source *source, const peer *theirs, exp_claims *claims, peer *ours)
{
    sl_status status = SL_OK;
    exp_mesh mesh = {0};
    sl_atlas *atlas = NULL;
    atlas_row row;
    sl_atlas_def def = variant_def(NONE, NULL);
    def.optimize.empty_cost = 0.0; /* charts and seams alone are compared */
    def.optimize.target_stretch = theirs->l2;
    def.optimize.target_angle = largest_angle;
    SL_TRY(exp_mesh_load(source, &mesh, &run->diag));
    SL_TRY(make_atlas(run, source->name, &mesh, &def, &atlas, &row));
    *ours = (peer){.tool = "ours",
                   .charts = row.charts,
                   .seam = row.seam,
                   .angle = row.angle,
                   .l2 = row.l2,
                   .fill = row.fill,
                   .seconds = row.seconds};
    memcpy(ours->mesh, theirs->mesh, sizeof ours->mesh);
    exp_claims_measure(claims, source->name, "peers: check passed", row.made && row.passed);
    exp_claims_measure(claims, source->name, "peers: charts over UVAtlas's", row.charts / theirs->charts);
    exp_claims_measure(claims, source->name, "peers: seams over UVAtlas's", row.seam / theirs->seam);
    fprintf(stderr, "%s at UVAtlas's L2: %d chart%s for %.0f, seams %.2f for %.2f, %.1f s\n", source->name, row.charts,
            sl_plural(row.charts), theirs->charts, row.seam, theirs->seam, row.seconds);
cleanup:
    sl_atlas_free(atlas);
    exp_mesh_clear(&mesh);
    return status;
}

/* The corpus's mesh that a row is about; -1 = none, or one too large for this page. */
static int32_t find_mesh(const exp_source *source, int32_t count, const char *name)
{
    for (int32_t k = 0; k < count; k++) {
        if (!source[k].generated && is_small_mesh(source[k].name) && strcmp(source[k].name, name) == 0) {
            return k;
        }
    }
    return -1;
}

/* For every mesh of the table: all tools' rows, then ours. */
static sl_status compare(exp_run *run, exp_page *page, exp_claims *claims, const peer_table *table)
{
    sl_status status = SL_OK;
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    double charts = 0.0, seams = 0.0;
    int32_t meshes = 0;
    SL_TRY(source != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    const int32_t count = exp_list_sources(run, source);
    for (int32_t k = 0; k < table->count; k++) {
        const peer *theirs = &table->row[k];
        const int32_t m = strcmp(theirs->tool, compared) == 0 ? find_mesh(source, count, theirs->mesh) : -1;
        if (m < 0) {
            continue;
        }
        peer ours = {0};
        for (int32_t i = 0; i < table->count; i++) {
            if (strcmp(table->row[i].mesh, theirs->mesh) == 0) {
                show_row(page, &table->row[i]);
            }
        }
        SL_TRY(reach(run, &source[m], theirs, claims, &ours));
        show_row(page, &ours);
        charts += ours.charts / theirs->charts;
        seams += ours.seam / theirs->seam;
        meshes++;
    }
    if (meshes > 0) {
        exp_claims_measure(claims, "all", "peers: mean of charts over UVAtlas's", charts / meshes);
        exp_claims_measure(claims, "all", "peers: mean of seams over UVAtlas's", seams / meshes);
    }
cleanup:
    sl_free(source);
    return status;
}

sl_status show_peers(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    char path[EXP_PATH];
    peer_table *table = sl_calloc(1, sizeof *table);
    SL_TRY(table != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    const bool live = find_table(run, path);
    SL_TRY(read_table(live ? path : recorded, table, &run->diag));
    exp_page_html(page, "<h3>Beside other tools</h3>\n<p>%s</p>\n",
                  live ? "What other tools made of the same meshes, and ours at UVAtlas's L2 and mean "
                         "&sigma;<sub>1</sub>/&sigma;<sub>2</sub> 1.2 (symmetry off, nothing protected)."
                       : "Recorded (<code>reports/reference/atlases-ours.csv</code>; one thread of a 2.6 GHz Xeon that "
                         "others used, too): ours on small meshes, at the distortion that each named tool reached. "
                         "With <code>SEAMLAB_CORPUS</code> a folder that holds these meshes and "
                         "<code>SEAMLAB_PEERS</code> a table of other tools' rows, both stand here, measured anew.");
    exp_page_table_begin(page, "mesh|tool|charts|seams|L2|&sigma;<sub>1</sub>/&sigma;<sub>2</sub>|fill|CPU s");
    if (live) {
        SL_TRY(add_claims(claims, &run->diag));
        SL_TRY(compare(run, page, claims, table));
    }
    for (int32_t k = 0; k < table->count && !live; k++) {
        show_row(page, &table->row[k]);
    }
    exp_page_table_end(page);
cleanup:
    sl_free(table);
    return status;
}
