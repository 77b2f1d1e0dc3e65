// SPDX-License-Identifier: Apache-2.0
// Fuzzes the file with the secrets of a haptic link.
#include "base/input_error.hpp"
#include "haptic_bridge/link/secret_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

SANDWALL_FUZZER(secret) {
    fuzz::takeOrRefuse([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        const haptic_bridge::Secrets secrets = haptic_bridge::parseSecrets(text, "secrets");
        for (const auto& secret : {secrets.move, secrets.watch}) {
            if (secret && (secret->size() < haptic_bridge::kMinSecret || secret->size() > haptic_bridge::kMaxSecret ||
                           text.find(*secret) == std::string_view::npos)) {
                throw std::logic_error("a secret has a bad length or is not in the file");
            }
        }
    });
    return 0;
}
