// SPDX-License-Identifier: Apache-2.0
// Compiles Asio once, because other units would spend most of their compile time on it.
#include <boost/asio/impl/src.hpp>
