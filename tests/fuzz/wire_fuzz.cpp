// SPDX-License-Identifier: Apache-2.0
// Fuzzes a stream of the haptic link, cut anywhere, in either direction, with states and loads expected or not.
#include "haptic_bridge/link/message_reader.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(wire) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input input(data, size);
    haptic_bridge::MessageReader reader;
    reader.expectState((input[0] & 1U) != 0);
    reader.expectLoads((input[0] & 2U) != 0);
    const std::size_t step = (input[0] >> 2U) + 1U;
    fuzz::takeOrRefuse([&] {
        for (fuzz::Input rest = input.subspan(1); !rest.empty();) {
            const std::size_t count = step < rest.size() ? step : rest.size();
            reader.feed(rest.first(count));
            rest = rest.subspan(count);
            while (const auto message = reader.next()) {
                // An accepted message must be equal after it is encoded and decoded.
                const base::Bytes again = haptic_bridge::encode(*message);
                if (haptic_bridge::decode(fuzz::Input(again).subspan(4)) != *message) {
                    throw std::logic_error("a message differs after it is encoded and decoded");
                }
            }
        }
    });
    return 0;
}
