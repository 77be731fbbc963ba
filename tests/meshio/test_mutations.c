/* Small files of every format, damaged at random: each must give a status, and whatever is read must be sound enough to
 * be built into a mesh and written again. Run under a checker of memory this finds reads past the end and leaks. */
#include "mesh/build.h"
#include "meshio_support.h"

enum { SEEDS = 7, CASES = 2500 };

typedef struct seed {
    const char *name;
    test_bytes bytes;
} seed;

static const char *const obj_seed =
    "mtllib a.mtl\no x\nv 0.1 0.2 0.3\nv 1e-3 1.5e1 -7.25 0.5 0.5 1\nv 3 4 5\nv -7 8 9.5\n"
    "vt 0.5 0.25\nvt 0.125 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1\nf -4//1 \\\n -1//1 2//1 \n"
    "f 4/2 2/1 3/2 # c\nl 1/1 2/2\np 3\ns off\n";
static const char *const off_seed =
    "STCOFF\n# c\n4 3 0\n0 0 0 255 0 0 255 0.5 0.5\n1 0 0 1 1 1 1 0 0\n0 1 0.5 3 4 5 6 7 8\n"
    "0.25 0.5 2 0 0 0 0 1 1\n3 0 1 2\n3 0 3 1 0.5 0.5 0.5\n3 1 3 2\n";
static const char *const ply_seed =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n"
    "element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty short id\n"
    "element edge 1\nproperty int a\nproperty list char int b\nend_header\n"
    "0 0 0 1 2 3 0 0\n1 0 0.5 4 5 6 1 0\n0 1 0 7 8 9 0 1\n0.5 0.5 2 1 1 1 1 1\n"
    "3 0 1 2 6 0 0 1 0 0 1 17\n3 0 3 1 0 18\n3 1 3 2 6 .5 .5 1 1 0 1 19\n5 2 6 7\n";
static const char *const strip_seed =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\nelement tristrips 1\n"
    "property list int int vertex_indices\nend_header\n0 0 0 1 0 5 0 1 7 2 2 3\n8 0 1 2 3 -1 0 2 3\n";

/* A binary PLY of either order: 4 vertices of float, 3 triangles with a label. */
static test_bytes binary_seed(bool big)
{
    static const unsigned char numbers[] = {0x3f, 0xc0, 0,    0,
                                            0x40, 0x48, 0xf5, 0xc3}; /* 1.5f, 3.14f, high byte first */
    static const unsigned char faces[] = {3, 0, 1, 2, 9, 3, 0, 3, 1, 8, 3, 1, 3, 2, 7};
    test_bytes to = {0};
    put_text(&to,
             "ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
             "property float z\nelement face 3\nproperty list uchar uchar vertex_indices\nproperty char label\n"
             "end_header\n",
             big ? "big" : "little");
    for (int k = 0; k < 12; k++) {
        for (int b = 0; b < 4; b++) {
            const unsigned char byte = (unsigned char)(numbers[4 * (k % 2) + (big ? b : 3 - b)] ^ (b == 1 ? k : 0));
            put_bytes(&to, &byte, 1);
        }
    }
    put_bytes(&to, faces, sizeof faces);
    return to;
}

static void make_seeds(seed seeds[SEEDS])
{
    seeds[0].name = "a.obj";
    put_text(&seeds[0].bytes, "%s", obj_seed);
    seeds[1].name = "a.off";
    put_text(&seeds[1].bytes, "%s", off_seed);
    seeds[2].name = "a.ply";
    put_bytes(&seeds[2].bytes, ply_seed, (int64_t)strlen(ply_seed));
    seeds[3].name = "a.ply";
    put_text(&seeds[3].bytes, "%s", strip_seed);
    seeds[4].name = "a.ply";
    seeds[4].bytes = binary_seed(false);
    seeds[5].name = "a.ply";
    seeds[5].bytes = binary_seed(true);
    seeds[6].name = "-"; /* the format is told by the damaged content */
    put_text(&seeds[6].bytes, "%s", off_seed);
}

/* Some flipped bits, replaced characters, doubled or removed pieces, a cut. */
static void damage(test_rng *rng, test_bytes *bytes)
{
    static const char tricky[] = "0123456789-+.eE/\\#\n\r \t,infa\"\xff\x80\x7f";
    for (int hits = 1 + test_index(rng, 6); hits > 0 && bytes->size > 0; hits--) {
        const int64_t at = test_index(rng, (int32_t)bytes->size);
        const int64_t n = test_index(rng, (int32_t)(bytes->size - at < 40 ? bytes->size - at : 40));
        switch (test_index(rng, 6)) {
        case 0:
            bytes->data[at] = (char)(bytes->data[at] ^ 1 << test_index(rng, 8));
            break;
        case 1:
        case 2:
            bytes->data[at] = tricky[test_index(rng, (int32_t)sizeof tricky)];
            break;
        case 3: /* a piece goes */
            memmove(bytes->data + at, bytes->data + at + n, (size_t)(bytes->size - at - n));
            bytes->size -= n;
            break;
        case 4: { /* a piece comes again at the end */
            char piece[40];
            memcpy(piece, bytes->data + at, (size_t)n);
            put_bytes(bytes, piece, n);
            break;
        }
        default:
            bytes->size = test_index(rng, 4) == 0 ? at : bytes->size;
            break;
        }
    }
}

/* Everything the header of meshfile promises of a file that was read. */
static void assert_sound(const sl_meshfile *file)
{
    assert_true(file->nf > 0 && file->face_first[0] == 0);
    for (int32_t f = 0; f < file->nf; f++) {
        assert_true(file->face_first[f + 1] - file->face_first[f] >= 3);
    }
    for (int32_t c = 0; c < file->face_first[file->nf]; c++) {
        assert_true(file->index[c] >= 0 && file->index[c] < file->nv);
        assert_true(file->corner_normal == NULL ||
                    (file->corner_normal[c] >= -1 && file->corner_normal[c] < file->normals));
        assert_true(file->corner_uv == NULL || (!isinf(file->corner_uv[2 * c]) && !isinf(file->corner_uv[2 * c + 1])));
    }
    for (int64_t k = 0; k < 3 * (int64_t)file->nv; k++) {
        assert_true(isfinite(file->xyz[k]));
    }
}

static void damaged_files_give_a_status_or_a_sound_mesh(void **state)
{
    (void)state;
    seed seeds[SEEDS] = {0};
    test_rng rng = test_rng_seed(900);
    int read = 0, built = 0;
    make_seeds(seeds);
    for (int s = 0; s < SEEDS; s++) {
        sl_meshfile_free(
            parse_bytes(seeds[s].name, seeds[s].bytes.data, seeds[s].bytes.size)); /* undamaged: it reads */
        for (int trial = 0; trial < CASES * test_multiplier(); trial++) {
            test_bytes bytes = {0};
            sl_meshfile *file;
            sl_mesh *mesh;
            sl_polygons polygons;
            sl_diag diag = sl_diag_none();
            put_bytes(&bytes, seeds[s].bytes.data, seeds[s].bytes.size);
            damage(&rng, &bytes);
            const sl_status status = sl_meshfile_parse(seeds[s].name, bytes.data, bytes.size, &file, &diag);
            if (status == SL_OK) {
                assert_sound(file);
                sl_meshfile_polygons(file, &polygons);
                read++;
                if (sl_mesh_build(&polygons, &mesh, NULL, &diag) == SL_OK) {
                    built++;
                    sl_mesh_free(mesh);
                }
                sl_meshfile_free(file);
            } else {
                assert_true(status == SL_BAD_INPUT || status == SL_UNSUPPORTED);
                assert_null(file);
                assert_true(diag.reason[0] != '\0');
            }
            sl_free(bytes.data);
        }
    }
    assert_true(read > SEEDS * CASES / 20 && built > SEEDS * CASES / 40); /* the damage leaves enough to go on with */
    for (int s = 0; s < SEEDS; s++) {
        sl_free(seeds[s].bytes.data);
    }
}

static void damaged_files_that_read_are_written_and_read_again(void **state)
{
    (void)state;
    static const char *const outs[] = {"out.obj", "out.ply"};
    seed seeds[SEEDS] = {0};
    test_rng rng = test_rng_seed(901);
    make_seeds(seeds);
    for (int s = 0; s < SEEDS; s++) {
        for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
            test_bytes bytes = {0};
            sl_meshfile *file;
            put_bytes(&bytes, seeds[s].bytes.data, seeds[s].bytes.size);
            damage(&rng, &bytes);
            if (sl_meshfile_parse(seeds[s].name, bytes.data, bytes.size, &file, NULL) == SL_OK) {
                int64_t size;
                double *uv = random_uv(&rng, file);
                char *data = write_and_load(outs[trial % 2], file, uv, &size);
                sl_meshfile *again = parse_bytes(outs[trial % 2], data, size);
                assert_same_polygons(file, again);
                assert_true(again->corner_uv != NULL ||
                            strcmp(outs[trial % 2], "out.obj") == 0); /* all NaN leaves no trace in OBJ */
                if (again->corner_uv != NULL) {
                    assert_same_doubles(again->corner_uv, uv, 2 * (int64_t)file->face_first[file->nf]);
                }
                sl_meshfile_free(again);
                sl_free(data);
                sl_free(uv);
                sl_meshfile_free(file);
            }
            sl_free(bytes.data);
        }
        sl_free(seeds[s].bytes.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_files_give_a_status_or_a_sound_mesh),
        cmocka_unit_test(damaged_files_that_read_are_written_and_read_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
