// SPDX-License-Identifier: GPL-3.0-or-later
#include "seekable_output.h"

#include <sstream>
#include <string_view>

namespace vmap {

void write_seekable(FileWriter& file, const std::function<void(std::ostream&)>& write) {
    if (file.seekable()) {
        write(file.stream());
        return;
    }
    std::ostringstream memory;
    memory.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    write(memory);
    const std::string_view bytes = memory.view();
    file.write(bytes.data(), bytes.size());
}

}  // namespace vmap
