/* Figure 16: a quad mesh with its dual graph, and the graph's symmetry. */
#include "figure.h"
#include "support/main.h"

#include <stdio.h>

static void introduce(exp_page *page, const symmetric_graph *g)
{
    exp_page_html(
        page,
        "<p>Figure 16 of the paper: left, a quad mesh with its dual graph in black, a node a facet; right, the "
        "symmetry of "
        "that graph, found by the program: edges of <i>A&prime;</i> (within a half) in grey, edges of <i>A&Prime;</i> "
        "(between the halves) in green, the facets <i>V</i><sup>1</sup> in blue and <i>V</i><sup>2</sup> in red. Here "
        "n&nbsp;=&nbsp;%d pairs of facets, %d edges in each half, %d between them. All of those join a facet with its "
        "own "
        "image: <i>A&Prime;</i> is diagonal, and the graph's axis is the mesh's.</p>\n",
        g->pairs, g->inner / 2, g->crossing);
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    symmetric_graph g = {0};
    SL_TRY(figure_mesh(&mesh, &run->diag));
    SL_TRY(symmetric_graph_create(mesh, &run->context, &g));
    exp_claims_measure(claims, "turtle", "facets without an image of their own", mesh->nf - 2 * g.pairs);
    exp_claims_measure(claims, "turtle", "edges of A'' off the diagonal", g.off_diagonal);
    exp_claims_measure(claims, "turtle", "edges of A'' without those of the axis", g.crossing - g.axis_edges);
    exp_claims_measure(claims, "turtle", "edges of A' whose image is no edge", g.broken);
    introduce(page, &g);
    SL_TRY(draw_graph(run, mesh, &g, false, "dual-graph.png"));
    SL_TRY(draw_graph(run, mesh, &g, true, "symmetry.png"));
    exp_page_html(page, "<div class=\"grid wide\">\n");
    exp_page_figure(page, "", "dual-graph.png", "a mesh of quads with its dual graph in black",
                    "A quad mesh with its dual graph.");
    exp_page_figure(page, "", "symmetry.png", "the dual graph, its halves in blue and red, edges between them in green",
                    "Its symmetry: <i>A&prime;</i> grey, <i>A&Prime;</i> green, <i>V</i><sup>1</sup> blue, "
                    "<i>V</i><sup>2</sup> red.");
    exp_page_html(page, "</div>\n");
cleanup:
    symmetric_graph_clear(&g);
    sl_mesh_free(mesh);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig16-dual-graph", "Figure 16: the dual graph and its symmetry", NULL, EXPECTED_CSV,
                    show);
}
