// One table of kernels for one instruction set: DEODAR_VECTORS is its name. _build.py compiles this file once
// for each.
#include "kernels.h"

#include "cells.h"
#include "line.h"
#include "noise.h"
#include "plane.h"

#define DEODAR_JOINED(a, b) a##b
#define DEODAR_TABLE(name) DEODAR_JOINED(kernels_, name)
#define DEODAR_TEXT_OF(name) #name
#define DEODAR_TEXT(name) DEODAR_TEXT_OF(name)

namespace deodar {

extern const Kernels DEODAR_TABLE(DEODAR_VECTORS);
const Kernels DEODAR_TABLE(DEODAR_VECTORS) = {
    DEODAR_TEXT(DEODAR_VECTORS), bits,          noise, line,         line_scratch, plane_to_modes,
    plane_from_modes,            plane_scratch, cells, cells_scratch};

}  // namespace deodar
