// SPDX-License-Identifier: Apache-2.0
// xxHash, compiled from its header.
#define XXH_STATIC_LINKING_ONLY
#define XXH_IMPLEMENTATION
#include <xxhash.h>
