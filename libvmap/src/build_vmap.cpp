// SPDX-License-Identifier: Apache-2.0
#include "build_methods.h"

#include <vmap/build_vmap.h>

namespace vmap {

VisibilityMap build_vmap(const Tree& tree, VmapMethod method, const ProgressCallback& progress) {
    switch (method) {
        case VmapMethod::exhaustive:
            return build_exhaustive(tree, progress);
        case VmapMethod::seed:
            return build_as_seed(tree, progress);
        case VmapMethod::fast:
            break;
    }
    return build_fast(tree, progress);
}

}  // namespace vmap
