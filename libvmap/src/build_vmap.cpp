// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"

#include <vmap/build_vmap.h>

namespace vmap {

VisibilityMap build_vmap(const Tree& tree, VmapMethod method, const ProgressCallback& progress) {
    return method == VmapMethod::exhaustive ? build_exhaustive(tree, progress) : build_as_seed(tree, progress);
}

}  // namespace vmap
