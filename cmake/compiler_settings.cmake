# SPDX-License-Identifier: GPL-3.0-or-later
# One place for the language level, warnings and sanitizers of every target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# Contraction would let the compiler's choice of fused operations change results between builds.
add_compile_options(-ffp-contract=off)

set(VMAP_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, for instance address,undefined")
if(VMAP_SANITIZE)
    add_compile_options(-fsanitize=${VMAP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -UNDEBUG)
    add_link_options(-fsanitize=${VMAP_SANITIZE})
endif()

# Call on every target of ours; headers of libraries are system headers and stay quiet.
function(vmap_strict_warnings target)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                             -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Werror
                                             # Designated initializers leave out what keeps its default.
                                             -Wno-missing-field-initializers
                                             # GCC 12 sees overlaps in std::string that are not there (bug 105651).
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-error=restrict>)
endfunction()
