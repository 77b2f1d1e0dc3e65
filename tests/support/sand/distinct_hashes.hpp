// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

namespace test {

/// Hashes that must all differ.
class DistinctHashes {
public:
    /// Adds a name for `hash`, and expects that no other name has it.
    void add(const std::string& name, std::uint64_t hash) {
        const auto [found, isNew] = names_.emplace(hash, name);
        EXPECT_TRUE(isNew) << name << " has the hash of " << found->second;
    }

private:
    std::map<std::uint64_t, std::string> names_;
};

}  // namespace test
