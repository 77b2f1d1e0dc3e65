// SPDX-License-Identifier: Apache-2.0
#include "sand/tin_module.hpp"

#include "sand/tin/start_maker.hpp"
#include "sand/tin/tin_surface.hpp"

namespace {

class Module final : public sand::TinModule {
public:
    [[nodiscard]] std::unique_ptr<sand::Surface> surface(const sand::Scene& scene) const override {
        return std::make_unique<sand::tin::TinSurface>(scene);
    }
    [[nodiscard]] sand::tin::Start follow(const sand::HeightField& field, const sand::Ground* walls,
                                          const sand::tin::Settings& settings) const override {
        return sand::tin::follow(field, walls, settings);
    }
    [[nodiscard]] sand::tin::Start join(const sand::tin::Start& start) const override { return sand::tin::join(start); }
    [[nodiscard]] sand::tin::Start startOf(const sand::Surface& surface) const override {
        const auto& tin = dynamic_cast<const sand::tin::TinSurface&>(surface);
        return sand::tin::startOf(tin.layer(), tin.start().settings);
    }
};

}  // namespace

extern "C" [[gnu::visibility("default")]] const sand::TinModule* sandwallTin1() {
    static const Module module;
    return &module;
}
