// SPDX-License-Identifier: Apache-2.0
// Compiles Asio once. Units that use it would otherwise spend most of their compile time on it.
#include <boost/asio/impl/src.hpp>
