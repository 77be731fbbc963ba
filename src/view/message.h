/* What a page says to the server.
 * Layer: view. */
#ifndef SL_VIEW_MESSAGE_H
#define SL_VIEW_MESSAGE_H

#include "edit/action.h"

enum { SL_MESSAGE_LONGEST = 65536 }; /* bytes */

/* JSON text, one object a message:
 *
 *     {"t":"look","pane":"3d","w":640,"h":480,"azimuth":35,"elevation":20,"zoom":1,"x":0,"y":0,"still":false}
 *     {"t":"look","pane":"uv","w":640,"h":480,"zoom":1,"x":0.5,"y":0.5,"still":true}      x, y: centre of the pane
 *     {"t":"seen","pane":"3d"}                a frame has arrived: the next one may be sent
 *     {"t":"at","pane":"uv","x":10,"y":20}    what is under the pointer, in pixels
 *     {"t":"arc","at":[v,w,f]}                the seam through an edge, for the zipper
 *     {"t":"do","line":{"do":"undo"}}         an action, as a session's script has it
 *     {"t":"drag","line":{...}}  {"t":"release","line":{...}}  {"t":"let-go"}
 *     {"t":"goto","step":3}                   undo or redo until so many actions are done
 *     {"t":"show","what":"checker"}           or charts, stretch, plain, texture
 *     {"t":"save","overlap":false}
 *     {"t":"stop"}                            cancels long work; handled out of turn */
typedef enum sl_message_kind {
    SL_MESSAGE_LOOK,
    SL_MESSAGE_SEEN,
    SL_MESSAGE_AT,
    SL_MESSAGE_ARC,
    SL_MESSAGE_DO,
    SL_MESSAGE_DRAG,
    SL_MESSAGE_RELEASE,
    SL_MESSAGE_LET_GO,
    SL_MESSAGE_GOTO,
    SL_MESSAGE_SHOW,
    SL_MESSAGE_SAVE,
    SL_MESSAGE_STOP,
    SL_MESSAGE_KINDS
} sl_message_kind;

typedef enum sl_pane { SL_PANE_3D, SL_PANE_UV, SL_PANES } sl_pane;

typedef enum sl_shown {
    SL_SHOW_CHECKER,
    SL_SHOW_CHARTS,
    SL_SHOW_STRETCH,
    SL_SHOW_PLAIN,
    SL_SHOW_TEXTURE,
    SL_SHOWN_KINDS
} sl_shown;

/* How a pane is looked at. */
typedef struct sl_look {
    int32_t width, height;     /* pixels, 16 to 4096 */
    double azimuth, elevation; /* degrees; 3D */
    double zoom;               /* 1 = all of it; 1e-3 to 1e6 */
    double x, y;               /* 3D: shift in radii of the model; UV: the centre */
    bool still;                /* nothing moves: a sharp picture, please */
} sl_look;

typedef struct sl_message {
    sl_message_kind kind;
    sl_pane pane;
    sl_look look;
    int32_t x, y;     /* at */
    int32_t side[3];  /* arc: input numbers */
    int32_t step;     /* goto */
    sl_shown shown;   /* show */
    bool overlap;     /* save */
    sl_action action; /* do, drag, release: owned */
} sl_message;

/* Parses a message. SL_BAD_INPUT: why stands in diag. SL_OUT_OF_MEMORY. Nothing is owned by *out on failure. */
SL_NODISCARD sl_status sl_message_parse(const char *text, int64_t size, sl_message *out, sl_diag *diag);
void sl_message_clear(sl_message *message);

#endif
