// SPDX-License-Identifier: Apache-2.0
// Asio, compiled once for all that use it: it is most of what their units would compile.
#include <boost/asio/impl/src.hpp>
