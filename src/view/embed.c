/* Build tool: files into a C table. embed OUT.c FILE... */
#include <stdio.h>
#include <string.h>

static const char *type_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot == NULL                 ? "application/octet-stream"
           : strcmp(dot, ".html") == 0 ? "text/html; charset=utf-8"
           : strcmp(dot, ".css") == 0  ? "text/css; charset=utf-8"
           : strcmp(dot, ".js") == 0   ? "text/javascript; charset=utf-8"
           : strcmp(dot, ".svg") == 0  ? "image/svg+xml"
                                       : "application/octet-stream";
}

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static int write_bytes(FILE *out, const char *path, int number)
{
    FILE *in = fopen(path, "rb");
    int c, column = 0;
    if (in == NULL) {
        fprintf(stderr, "embed: cannot open %s\n", path);
        return 1;
    }
    fprintf(out, "static const unsigned char file_%d[] = {", number);
    while ((c = getc(in)) != EOF) {
        fprintf(out, "%s%d,", column++ % 24 == 0 ? "\n    " : "", c);
    }
    fprintf(out, "\n    0};\n");
    return fclose(in);
}

int main(int argc, char **argv)
{
    FILE *out = argc > 2 ? fopen(argv[1], "w") : NULL;
    int failed = out == NULL;
    if (out != NULL) {
        fprintf(out, "/* Made from page/ by embed.c. */\n#include \"view/server_internal.h\"\n\n");
        for (int k = 2; k < argc; k++) {
            failed |= write_bytes(out, argv[k], k);
        }
        fprintf(out, "\nconst sl_page_file sl_page_files[] = {\n");
        for (int k = 2; k < argc; k++) {
            const char *name = base_of(argv[k]);
            fprintf(out, "    {\"/%s\", \"%s\", file_%d, sizeof file_%d - 1},\n",
                    strcmp(name, "index.html") == 0 ? "" : name, type_of(name), k, k);
        }
        fprintf(out, "};\nconst int32_t sl_page_file_count = %d;\n", argc - 2);
        failed |= fclose(out);
    }
    return failed;
}
