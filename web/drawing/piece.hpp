// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace web {

/// Arrays of numbers for the page, by name. web/replica/messages.ts describes them.
struct Piece {
    /// In the order of kArrays in web/replica/replica.ts.
    using Numbers = std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                                 std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<std::uint8_t>>;
    struct Array {
        std::string name;
        Numbers numbers;
    };
    std::vector<Array> arrays{};

    void add(std::string name, Numbers numbers) { arrays.push_back({std::move(name), std::move(numbers)}); }
    void add(std::string name, float number) { add(std::move(name), std::vector<float>{number}); }
};

}  // namespace web
