// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "host/version.hpp"
#include "journal/format.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"

namespace test {

inline constexpr std::int64_t kGibibyte = std::int64_t{1} << 30;

/// Tests of the memory that the sand of a journal needs. The journal has only a header.
class HugeJournal : public FolderTest {
protected:
    /// Writes a journal that has only a header. `scene` becomes the scene in it.
    std::filesystem::path journalOf(const base::Bytes& scene) {
        journal::JournalHeader header;
        header.session = 1;
        header.scene = scene;
        header.material = scene::Material();
        std::uint64_t chain = 0;
        const base::Bytes bytes = journal::encodeHeader(header, host::release(), chain);
        std::ofstream(journal_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return journal_;
    }

    /// Returns the first bytes of a scene of 16384 x 16384 cells.
    static base::Bytes rulesOfAHugeField() {
        sand::Rules rules;
        rules.columns = rules.rows = 16384;
        rules.tuning.sweepsPerStep = 8;
        rules.stepsPerSecond = 60;
        base::ByteWriter writer;
        writer.putText("huge");
        base::putMember(writer, rules);
        return writer.take();
    }

    const std::filesystem::path journal_ = folder_ / "session.journal";
};

}  // namespace test
