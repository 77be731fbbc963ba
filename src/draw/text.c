#include "draw/text.h"

#include <math.h>

enum {
    FIRST_CHARACTER = 32,
    CURVE_PIECES = 6, /* segments of a quadratic curve */
    BASELINE = 3,     /* grid row of the baseline; capitals reach row 13 */
    SPACE_WIDTH = 4,
    MAX_TEXT = 4096, /* characters drawn of one text */
};

static const double capital_rows = 10.0;
static const double gap = 2.7;    /* grid columns between characters */
static const double weight = 1.2; /* stroke width in grid columns */

/* Strokes on a grid, column and row as hexadecimal digits, row 3 = baseline, a = height of small letters, d = of
 * capitals, 0 = foot of descenders. A point after `*` is the control point of a quadratic curve; between two of them
 * the curve passes their middle. A blank lifts the pen. */
static const char *const glyphs[] = {
    "",                                                      /* space */
    "0d06 0303",                                             /* ! */
    "0d0a 2d2a",                                             /* " */
    "133d 537d 0676 1a8a",                                   /* # */
    "7b*7d4d*0d0b*0948*8785*8343*0305 4e42",                 /* $ */
    "2d*4d*4929*09*0d2d 77*97*9373*53*5777 8d13",            /* % */
    "731a*0d3d*5d5b*5a28*0705*0333*6378",                    /* & */
    "0d0a",                                                  /* ' */
    "2e*0b08*0521",                                          /* ( */
    "0e*2b28*2501",                                          /* ) */
    "3d39 1c5a 1a5c",                                        /* * */
    "0767 343a",                                             /* + */
    "1301",                                                  /* , */
    "0747",                                                  /* - */
    "0303",                                                  /* . */
    "025d",                                                  /* / */
    "3d*6d68*6333*0308*0d3d",                                /* 0 */
    "0a3d33",                                                /* 1 */
    "0a*0d3d*6d6a*68360363",                                 /* 2 */
    "0b*0d3d*6d6b*683828 38*6865*6333*0305",                 /* 3 */
    "535d0676",                                              /* 4 */
    "6d0d08*1a3a*6a67*6333*0305",                            /* 5 */
    "6c*5d3d*0d06*0333*6366*6939*0906",                      /* 6 */
    "0d6d23",                                                /* 7 */
    "3d*5d5b*5939*191b*1d3d 39*6966*6333*0306*0939",         /* 8 */
    "04*1333*636a*6d3d*0d0a*0737*676a",                      /* 9 */
    "0303 0808",                                             /* : */
    "1301 1808",                                             /* ; */
    "6b0763",                                                /* < */
    "0565 0969",                                             /* = */
    "0b6703",                                                /* > */
    "0b*0d3d*6d*693836 3333",                                /* ? */
    "7a76*7585*a5a8*ad5d*0d08*0252*7283 5a*7a*7555*35*3a5a", /* @ */
    "034d83 1676",                                           /* A */
    "030d4d*7d*784808 48*88*834303",                         /* B */
    "8b*7d4d*0d08*0343*7385",                                /* C */
    "030d3d*8d88*833303",                                    /* D */
    "7d0d0373 0868",                                         /* E */
    "7d0d03 0868",                                           /* F */
    "8b*7d4d*0d08*0343*73858858",                            /* G */
    "030d 838d 0888",                                        /* H */
    "030d",                                                  /* I */
    "5d56*5323*0305",                                        /* J */
    "030d 7d06 3973",                                        /* K */
    "0d0373",                                                /* L */
    "030d468d83",                                            /* M */
    "030d838d",                                              /* N */
    "4d*8d88*8343*0308*0d4d",                                /* O */
    "030d4d*7d*774707",                                      /* P */
    "4d*8d88*8343*0308*0d4d 5682",                           /* Q */
    "030d4d*7d*774707 4773",                                 /* R */
    "7b*7d4d*0d0b*0948*8785*8343*0305",                      /* S */
    "0d8d 4d43",                                             /* T */
    "0d07*0343*83878d",                                      /* U */
    "0d438d",                                                /* V */
    "0d336c93cd",                                            /* W */
    "038d 0d83",                                             /* X */
    "0d488d 4843",                                           /* Y */
    "0d8d0383",                                              /* Z */
    "2e0e0121",                                              /* [ */
    "0d52",                                                  /* \ */
    "0e2e2101",                                              /* ] */
    "0a3d6a",                                                /* ^ */
    "0171",                                                  /* _ */
    "0d2b",                                                  /* ` */
    "6a63 3a*6a*6333*03*0a3a",                               /* a */
    "0d03 3a*6a*6333*03*0a3a",                               /* b */
    "69*5a3a*0a*0333*5364",                                  /* c */
    "6d63 3a*6a*6333*03*0a3a",                               /* d */
    "0767*6a3a*0a*0333*5364",                                /* e */
    "4d*2d2a23 0a4a",                                        /* f */
    "6a62*6030*1011 3a*6a*6333*03*0a3a",                     /* g */
    "0d03 07*0a3a*6a6763",                                   /* h */
    "0a03 0d0d",                                             /* i */
    "2a22*2000 2d2d",                                        /* j */
    "0d03 5a05 2753",                                        /* k */
    "0d05*0323",                                             /* l */
    "0a03 07*0a3a*5a5753 57*5a8a*aaa7a3",                    /* m */
    "0a03 07*0a3a*6a6763",                                   /* n */
    "3a*6a*6333*03*0a3a",                                    /* o */
    "0a00 3a*6a*6333*03*0a3a",                               /* p */
    "6a60 3a*6a*6333*03*0a3a",                               /* q */
    "0a03 07*0a4a",                                          /* r */
    "59*4a3a*0a*0737*57*5323*1304",                          /* s */
    "2d25*2343 0a4a",                                        /* t */
    "0a06*0333*6366 6a63",                                   /* u */
    "0a336a",                                                /* v */
    "0a335973aa",                                            /* w */
    "036a 0a63",                                             /* x */
    "6a20 0a33",                                             /* y */
    "0a6a0363",                                              /* z */
    "3e*1e1b*1908*1715*1131",                                /* { */
    "0e01",                                                  /* | */
    "0e*2e2b*2938*2725*2101",                                /* } */
    "07*1a37*5467",                                          /* ~ */
};

static const char unknown[] = "030d6d6303";

static const char *glyph_of(char c)
{
    const int i = (int)(unsigned char)c - FIRST_CHARACTER;
    return i >= 0 && i < (int)SL_COUNTOF(glyphs) ? glyphs[i] : unknown;
}

static int digit(char c)
{
    return c >= 'a' ? c - 'a' + 10 : c - '0';
}

static int glyph_width(const char *glyph)
{
    int widest = glyph[0] == '\0' ? SPACE_WIDTH : 0;
    for (const char *g = glyph; *g != '\0'; g++) {
        if (*g != ' ' && *g != '*') {
            const int x = digit(*g++);
            widest = x > widest ? x : widest;
        }
    }
    return widest;
}

/* A pen on the mask. */
typedef struct pen {
    sl_mask *mask;
    double origin[2], unit;
    bool down, curving;
    double at[2], control[2]; /* grid */
} pen;

static void to_mask(const pen *p, const double grid[2], double out[2])
{
    out[0] = p->origin[0] + p->unit * grid[0];
    out[1] = p->origin[1] - p->unit * (grid[1] - BASELINE);
}

static void line_to(pen *p, const double to[2])
{
    double a[2], b[2];
    to_mask(p, p->at, a);
    to_mask(p, to, b);
    sl_mask_segment(p->mask, a, b, weight * p->unit);
    p->at[0] = to[0];
    p->at[1] = to[1];
}

static void curve_to(pen *p, const double to[2])
{
    const double from[2] = {p->at[0], p->at[1]};
    for (int i = 1; i <= CURVE_PIECES; i++) {
        const double t = (double)i / CURVE_PIECES, s = 1.0 - t;
        const double at[2] = {s * s * from[0] + 2.0 * s * t * p->control[0] + t * t * to[0],
                              s * s * from[1] + 2.0 * s * t * p->control[1] + t * t * to[1]};
        line_to(p, at);
    }
}

static void take_point(pen *p, const double point[2], bool control)
{
    if (control) {
        if (p->curving) {
            const double middle[2] = {0.5 * (p->control[0] + point[0]), 0.5 * (p->control[1] + point[1])};
            curve_to(p, middle);
        }
        p->control[0] = point[0];
        p->control[1] = point[1];
    } else if (p->curving) {
        curve_to(p, point);
    } else if (p->down) {
        line_to(p, point);
    }
    if (!control) {
        p->at[0] = point[0];
        p->at[1] = point[1];
    }
    p->curving = control;
    p->down = true;
}

static void draw_glyph(pen *p, const char *glyph)
{
    bool control = false;
    p->down = p->curving = false;
    for (const char *g = glyph; *g != '\0'; g++) {
        if (*g == ' ') {
            p->down = p->curving = false;
        } else if (*g == '*') {
            control = true;
        } else {
            const double point[2] = {digit(g[0]), digit(g[1])};
            take_point(p, point, control);
            control = false;
            g++;
        }
    }
}

void sl_mask_text(sl_mask *mask, const double at[2], double height, const char *text)
{
    pen p = {.mask = mask, .origin = {at[0], at[1]}, .unit = height / capital_rows};
    for (int i = 0; i < MAX_TEXT && text[i] != '\0'; i++) {
        const char *glyph = glyph_of(text[i]);
        draw_glyph(&p, glyph);
        p.origin[0] += (glyph_width(glyph) + gap) * p.unit;
    }
}

double sl_text_width(double height, const char *text)
{
    double columns = 0.0;
    for (int i = 0; i < MAX_TEXT && text[i] != '\0'; i++) {
        columns += glyph_width(glyph_of(text[i])) + gap;
    }
    return columns > 0.0 ? (columns - gap) * height / capital_rows : 0.0;
}
