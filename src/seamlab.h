/* Everything seamlab installs. Include this one header; build with `pkg-config --cflags --libs seamlab`. */
#ifndef SEAMLAB_H
#define SEAMLAB_H

#include "atlas/atlas.h"
#include "atlas/measure.h"
#include "atlas/sidecar.h"
#include "base/context.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/rng.h"
#include "base/status.h"
#include "base/text.h"
#include "eigen/lanczos.h"
#include "geom/predicates.h"
#include "graph/csr.h"
#include "mesh/build.h"
#include "mesh/facet_graph.h"
#include "mesh/patch.h"
#include "mesh/topology.h"
#include "meshio/meshfile.h"
#include "meshio/ply_export.h"
#include "overlap/certificate.h"
#include "overlap/coverage.h"
#include "pack/pack.h"
#include "param/flatten.h"
#include "param/lscm.h"
#include "param/tutte.h"
#include "segment/segment.h"
#include "sparse/cholesky.h"
#include "spectral/spectrum.h"

#endif
