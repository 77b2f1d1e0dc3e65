// SPDX-License-Identifier: Apache-2.0
#include "tracking/pose.hpp"

#include <cmath>

namespace tracking {
namespace {

/// Largest error of a rotation matrix. Trackers print six digits; a matrix with a larger error has other contents, such
/// as zeros.
constexpr double kRotationTolerance = 0.01;

/// Returns a turn from axis `from` towards axis `to`.
glm::dmat3 turn(int from, int to, double degrees) {
    const double cosine = std::cos(glm::radians(degrees)), sine = std::sin(glm::radians(degrees));
    glm::dmat3 matrix(1.0);
    matrix[from][from] = cosine;
    matrix[to][to] = cosine;
    matrix[from][to] = sine;
    matrix[to][from] = -sine;
    return matrix;
}

}  // namespace

glm::dmat3 rotationOf(double yaw, double pitch, double roll) {
    return turn(2, 0, yaw) * turn(1, 2, pitch) * turn(0, 1, roll);
}

bool plausible(const Measured& measured) {
    // Written so that a NaN fails every comparison.
    for (int i = 0; i < 3; ++i) {
        if (!(std::abs(measured.position[i]) <= kFarthest)) {
            return false;
        }
    }
    const glm::dmat3 product = glm::transpose(measured.rotation) * measured.rotation;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            if (!(std::abs(product[column][row] - (row == column ? 1 : 0)) <= kRotationTolerance)) {
                return false;
            }
        }
    }
    return glm::determinant(measured.rotation) > 0;
}

}  // namespace tracking
