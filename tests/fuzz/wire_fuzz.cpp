// SPDX-License-Identifier: Apache-2.0
// What comes over the haptic link: a stream cut anywhere, in either direction, states and loads expected or not.
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
                // What was understood can be said again, and is the same.
                const base::Bytes again = haptic_bridge::encode(*message);
                if (haptic_bridge::decode(fuzz::Input(again).subspan(4)) != *message) {
                    throw std::logic_error("a message that is another when it is said again");
                }
            }
        }
    });
    return 0;
}
