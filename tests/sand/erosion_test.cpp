// SPDX-License-Identifier: Apache-2.0
#include "sand/erosion.hpp"
#include <gtest/gtest.h>
TEST(Erosion, Placeholder) {}
