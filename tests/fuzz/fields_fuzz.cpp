// SPDX-License-Identifier: Apache-2.0
// Fuzzes every described type (base/fields.hpp) whose bytes come from outside. The first byte selects the type. Bytes
// are refused by the name of a field, or give a value that is the same after it is encoded and decoded.
#include "tests/described/faults.hpp"
#include "tests/described/types.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(fields) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input bytes = fuzz::Input(data, size).subspan(1);
    std::size_t number = 0;
    described::forEachType<described::Types>([&]<class T>() {
        if (number++ == data[0] % std::tuple_size_v<described::Types>) {
            bool accepted = false;
            const std::string fault = described::faultOf<T>(bytes, accepted);
            fuzz::require(fault.empty(), fault.c_str());
        }
    });
    return 0;
}
