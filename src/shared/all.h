// clang-format off
// Every formula of this folder, for C++ instances (math/scalar.h and the SIMD instances). GLSL includes single files.
// No include guard: each instance includes it inside a namespace of its own.
#include "shared/lang.h"
#include "shared/displace.h"
#include "shared/constants.h"
#include "shared/sobol.h"
#include "shared/warp.h"
#include "shared/camera.h"
#include "shared/tonemap.h"
#include "shared/ggx_albedo.h"
#include "shared/bsdf.h"
#include "shared/light.h"
#include "shared/bindings.h"
#include "shared/device_scene.h"
#include "shared/device_rays.h"
#include "shared/device_sort.h"
