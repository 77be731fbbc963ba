/* Everything seamlab installs.  Include this one header; link with `pkg-config --cflags --libs seamlab`. */
#ifndef SEAMLAB_H
#define SEAMLAB_H

#include "base/context.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/rng.h"
#include "base/status.h"
#include "base/text.h"

#endif
