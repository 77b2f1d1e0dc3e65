// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "tracking/pose.hpp"

namespace test {

/// Returns whether two vectors are at most `most` apart, and prints both if they are not.
inline testing::AssertionResult near(glm::dvec3 got, glm::dvec3 expected, double most = 1e-12) {
    if (glm::length(got - expected) <= most) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << "got (" << got.x << ", " << got.y << ", " << got.z << "), want ("
                                       << expected.x << ", " << expected.y << ", " << expected.z << ")";
}

inline base::Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

/// Returns six doubles as opentrack sends them: cm and degrees.
inline base::Bytes doubles(const std::vector<double>& values) {
    base::ByteWriter writer;
    for (const double value : values) {
        writer.put(value);
    }
    return writer.take();
}

}  // namespace test
