# SPDX-License-Identifier: Apache-2.0
# The page's replica for WebAssembly: base, sand, the values of a scene, the journal and the hand. scripts/web.sh configures it with
# emscripten's toolchain. Nothing else of the project is built then.
set(SANDWALL_NODE_MODULES ${PROJECT_SOURCE_DIR}/web/node_modules CACHE PATH "What npm ci has installed")

# The exceptions and vectors of WebAssembly, which all browsers have since 2023. Without the third option each conversion
# to a whole number would be a branch.
add_compile_options(-fwasm-exceptions -msimd128 -mnontrapping-fptoint)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_C_FLAGS_RELEASE "-Os -DNDEBUG")

# Headers of Debian's packages. All of /usr/include would hide emscripten's own headers.
set(headers ${PROJECT_BINARY_DIR}/headers)
foreach(header fmt fast_float glm xxhash.h)
    if(NOT EXISTS /usr/include/${header})
        message(FATAL_ERROR "/usr/include/${header} is missing; run scripts/install_dependencies.sh --with-web")
    endif()
    file(COPY /usr/include/${header} DESTINATION ${headers})
endforeach()
include_directories(SYSTEM ${headers})
add_library(fmt INTERFACE)
add_library(fmt::fmt ALIAS fmt)
add_compile_definitions(FMT_HEADER_ONLY)
add_library(glm INTERFACE)
add_library(glm::glm ALIAS glm)
add_library(xxhash STATIC web/xxhash.c)
# Every frame is hashed. xxHash knows no vectors of WebAssembly, but emscripten translates those of SSE2 to them.
target_compile_options(xxhash PRIVATE -O3 -msse2)
add_library(PkgConfig::XXHASH ALIAS xxhash)

# zstd from a pinned npm package, which has its sources. A replica uses level 1 alone.
set(zstd ${SANDWALL_NODE_MODULES}/zstd-napi/deps/zstd/lib)
file(GLOB zstd_sources ${zstd}/common/*.c ${zstd}/compress/*.c ${zstd}/decompress/*.c)
if(NOT zstd_sources)
    message(FATAL_ERROR "${zstd} is missing; run scripts/web.sh, which calls npm ci")
endif()
list(FILTER zstd_sources EXCLUDE REGEX "pool\\.c|threading\\.c|zstdmt")
add_library(zstd STATIC ${zstd_sources})
target_include_directories(zstd SYSTEM PUBLIC ${zstd})
target_compile_definitions(zstd PRIVATE ZSTD_DISABLE_ASM XXH_NAMESPACE=ZSTD_ ZSTD_EXCLUDE_DFAST_BLOCK_COMPRESSOR
    ZSTD_EXCLUDE_GREEDY_BLOCK_COMPRESSOR ZSTD_EXCLUDE_LAZY_BLOCK_COMPRESSOR ZSTD_EXCLUDE_LAZY2_BLOCK_COMPRESSOR
    ZSTD_EXCLUDE_BTLAZY2_BLOCK_COMPRESSOR ZSTD_EXCLUDE_BTOPT_BLOCK_COMPRESSOR ZSTD_EXCLUDE_BTULTRA_BLOCK_COMPRESSOR)
set_target_properties(zstd PROPERTIES UNITY_BUILD OFF)
add_library(PkgConfig::ZSTD ALIAS zstd)

add_subdirectory(base)
add_subdirectory(sand)
add_subdirectory(shapes)
add_subdirectory(scene)
add_subdirectory(journal)
add_subdirectory(haptic_bridge)
add_subdirectory(web)

# Long loops are in sand and shapes alone. Elsewhere the size of the page matters more than speed.
foreach(library base scene_model scene_text journal haptic_hand web web_functions)
    target_compile_options(${library} PRIVATE -Os)
endforeach()
