// SPDX-License-Identifier: Apache-2.0
#include "sand/tin_module.hpp"

#include "sand/tin/tin_surface.hpp"
