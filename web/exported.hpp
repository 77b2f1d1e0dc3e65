// SPDX-License-Identifier: Apache-2.0
// State that the functions for web/page/worker.ts share: the sand that is shown, and the sentence about the last
// failure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "web/drawing/drawing.hpp"
#include "web/hand/dug_session.hpp"
#include "web/replica/page_session.hpp"

#if defined(__EMSCRIPTEN__)
#include <emscripten.h>
#define SANDWALL_PAGE_API extern "C" EMSCRIPTEN_KEEPALIVE
#else  // only compiled
#define SANDWALL_PAGE_API extern "C"
#endif

namespace web {

/// All state of the page's program, which has one thread.
struct Exported {
    std::vector<base::Bytes> parts;       // of a file that is being handed over
    std::unique_ptr<StepSource> session;  // whose sand is shown; null before the first one
    std::optional<Drawing> drawing;       // of the session
    Piece piece;                          // of the drawing, for the page
    PageSession* recorded = nullptr;      // the session, if its steps are those of a journal
    DugSession* dug = nullptr;            // the session, if its steps are those of a hand
    std::array<double, 4> place{};        // of the sand that sw_look() has met
    base::Bytes bytes;                    // a state or a journal
    std::string problem;                  // sentence for the user
    std::string text;                     // text that the page reads next

    static constexpr const char* kNoMemory = "This page has no more memory";
    // A 32-bit heap that may grow to 2 GiB, less what journal and states take.
    static constexpr std::int64_t kMemory = std::int64_t{1536} << 20;  // [byte]

    void show(std::unique_ptr<PageSession> opened) {
        recorded = opened.get();
        dug = nullptr;
        show(std::unique_ptr<StepSource>(std::move(opened)));
    }
    void show(std::unique_ptr<DugSession> begun) {
        dug = begun.get();
        recorded = nullptr;
        show(std::unique_ptr<StepSource>(std::move(begun)));
    }
    void show(std::unique_ptr<StepSource> shown) {
        drawing.reset();
        session = std::move(shown);
        drawing.emplace(*session);
    }
    /// Returns the address of a text, which stays until the next one.
    const char* textAt(std::string next) {
        text = std::move(next);
        return text.c_str();
    }
    /// Returns what `work` returns, or -1 if it throws; `problem` then has the sentence.
    template <class Work>
    int guarded(Work&& work) {
        try {
            return work();
        } catch (const std::bad_alloc&) {
            problem = kNoMemory;
        } catch (const std::length_error&) {  // more than a container of 32 bits can have
            problem = kNoMemory;
        } catch (const std::exception& error) {
            problem = error.what();
        }
        return -1;
    }
    /// Gives `room` a new size. Returns its address, or nullptr if there is no memory.
    std::uint8_t* resized(base::Bytes& room, std::uint32_t size) {
        const auto resize = [&room, size] {
            room.reserve(std::max(size, 1U));  // an empty part has an address, too
            room.resize(size);
            return 0;
        };
        return guarded(resize) == 0 ? room.data() : nullptr;
    }
};

inline Exported exported;

}  // namespace web
