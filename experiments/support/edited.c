#include "support/edited.h"

#include "generators.h"

static void show_plate(exp_page *page, const char *class_name, const exp_plate *plate)
{
    if (plate->file != NULL) {
        exp_page_figure(page, class_name, plate->file, plate->alt, plate->caption);
    }
}

static sl_status edit(exp_editing *e, exp_page *page, const exp_edited *figure, const sl_polygons *polygons)
{
    sl_status status = SL_OK;
    exp_run *run = e->run;
    sl_action open = sl_action_default(SL_ACTION_OPEN), pack = sl_action_default(SL_ACTION_PACK);
    const sl_atlas_def def = exp_session_def();
    SL_TRY(sl_session_create(polygons, NULL, &open, &def, &run->context, &e->session, &run->diag));
    e->before = exp_session_state(e->session);
    SL_TRY(exp_session_draw(run, e->session, &e->view, &e->picture, figure->before.file));
    SL_TRY(figure->edit(e));
    SL_TRY(sl_session_apply(e->session, &pack, &run->context, &run->diag));
    e->after = exp_session_state(e->session);
    SL_TRY(exp_session_draw(run, e->session, &e->view, &e->picture, figure->after.file));
    if (figure->finish != NULL) {
        SL_TRY(figure->finish(e));
    }
    SL_TRY(exp_session_finish(run, e->session, polygons, figure->model, &def, e->claims));
    exp_claims_measure(e->claims, figure->model, "red facets", e->after.red);
    show_plate(page, "", &figure->before);
    show_plate(page, "yes", &figure->after);
    show_plate(page, "yes", &figure->more);
    exp_session_table(page, 2, (const char *const[]){"automatic", figure->row},
                      (const exp_state[]){e->before, e->after});
cleanup:
    sl_session_free(e->session);
    e->session = NULL;
    return status;
}

sl_status exp_edited_show(exp_run *run, exp_page *page, exp_claims *claims, const exp_edited *figure)
{
    sl_status status = SL_OK;
    sl_generated *generated = NULL;
    sl_polygons polygons;
    const sl_generator *generator = sl_generator_find(figure->model);
    SL_TRY(generator != NULL ? SL_OK : SL_INTERNAL);
    SL_TRY(generator->make(1, run->quick ? 0 : 1, &generated));
    sl_generated_polygons(generated, &polygons);
    exp_editing e = {.run = run,
                     .claims = claims,
                     .generated = generated,
                     .view = exp_view_of(figure->model),
                     .picture = exp_picture(run, figure->width, figure->height)};
    SL_TRY(edit(&e, page, figure, &polygons));
cleanup:
    sl_generated_free(generated);
    return status;
}
