// SPDX-License-Identifier: Apache-2.0
#include "bench/sand/relaxations.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/sand/baseline_schemes.hpp"
#include "bench/sand/integer_n4.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/settle.hpp"

namespace bench {
namespace {

std::vector<double> heightsOf(const sand::HeightField& field) {
    std::vector<double> heights;
    heights.reserve(static_cast<std::size_t>(field.columns()) * static_cast<std::size_t>(field.rows()));
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            heights.push_back(static_cast<double>(field.height(x, y)) / sand::kUnitsPerCell);
        }
    }
    return heights;
}

class Ours : public Relaxation {
public:
    Ours(const sand::HeightField& field, const sand::Rules& rules, const sand::grid::Erosion::Options& options)
        : field_(field), erosion_(field_, rules, options) {}
    void sweep(int count) override { erosion_.sweep(field_, count); }
    [[nodiscard]] bool atRest() const override { return erosion_.settled(); }
    [[nodiscard]] std::int64_t sweepsDone() const override { return erosion_.sweepsDone(); }
    [[nodiscard]] std::vector<double> heights() const override { return heightsOf(field_); }

private:
    sand::HeightField field_;
    sand::grid::Erosion erosion_;
};

class Baseline : public Relaxation {
public:
    Baseline(BaselineScheme scheme, const sand::HeightField& field, const sand::Rules& rules)
        : scheme_(scheme),
          talus_(static_cast<float>(rules.tuning.threshold) / sand::kUnitsPerCell),
          field_(field.columns()),
          scratch_(field.columns()),
          path_(base::fastestCodePath()) {
        if (field.columns() != field.rows()) {
            throw std::logic_error("the baselines need square fields");
        }
        for (int y = 0; y < field_.side; ++y) {
            for (int x = 0; x < field_.side; ++x) {
                field_.row(y)[x] = static_cast<float>(field.height(x, y)) / sand::kUnitsPerCell;
            }
        }
    }
    void sweep(int count) override {
        for (int i = 0; i < count && !atRest(); ++i) {
            largest_ = path_ != base::CodePath::baseline ? v3::sweep(scheme_, talus_, field_, scratch_)
                                                         : baseline::sweep(scheme_, talus_, field_, scratch_);
            ++sweepsDone_;
        }
    }
    [[nodiscard]] bool atRest() const override { return largest_ < kFloatTolerance; }
    [[nodiscard]] std::int64_t sweepsDone() const override { return sweepsDone_; }
    [[nodiscard]] std::vector<double> heights() const override {
        std::vector<double> heights;
        for (int y = 0; y < field_.side; ++y) {
            heights.insert(heights.end(), field_.row(y), field_.row(y) + field_.side);
        }
        return heights;
    }

private:
    BaselineScheme scheme_;
    float talus_;
    FloatField field_, scratch_;
    base::CodePath path_;
    std::int64_t sweepsDone_ = 0;
    float largest_ = 1;  // largest move in the last sweep [cell]
};

Method ours(const std::string& name, sand::Scheme scheme, bool skipSettled) {
    return {name, true, [=](const sand::HeightField& field, const sand::Rules& rules) -> std::unique_ptr<Relaxation> {
                sand::Rules own = rules;
                own.scheme = scheme;
                sand::grid::Erosion::Options options;
                options.skipSettled = skipSettled;
                return std::make_unique<Ours>(field, own, options);
            }};
}

/// Calls sand::grid::settle() in the first sweep, which brings the pile to rest.
class Direct : public Relaxation {
public:
    Direct(const sand::HeightField& field, const sand::Rules& rules) : field_(field), rules_(rules) {}
    void sweep(int count) override {
        if (count > 0 && !atRest_) {
            sweepsDone_ = sand::grid::settle(field_, rules_).sweeps;
            atRest_ = true;
        }
    }
    [[nodiscard]] bool atRest() const override { return atRest_; }
    [[nodiscard]] std::int64_t sweepsDone() const override { return sweepsDone_; }
    [[nodiscard]] std::vector<double> heights() const override { return heightsOf(field_); }

private:
    sand::HeightField field_;
    sand::Rules rules_;
    std::int64_t sweepsDone_ = 0;
    bool atRest_ = false;
};

Method direct() {
    return {"settle", true,
            [](const sand::HeightField& field, const sand::Rules& rules) -> std::unique_ptr<Relaxation> {
                return std::make_unique<Direct>(field, rules);
            }};
}

class FourNeighbours : public Relaxation {
public:
    FourNeighbours(const sand::HeightField& field, const sand::Rules& rules) : sand_(field, rules) {}
    void sweep(int count) override { sand_.sweep(count); }
    [[nodiscard]] bool atRest() const override { return sand_.atRest(); }
    [[nodiscard]] std::int64_t sweepsDone() const override { return sand_.sweepsDone(); }
    [[nodiscard]] std::vector<double> heights() const override { return heightsOf(sand_.field()); }

private:
    IntegerN4 sand_;
};

Method fourNeighbours() {
    return {"N4", true, [](const sand::HeightField& field, const sand::Rules& rules) -> std::unique_ptr<Relaxation> {
                return std::make_unique<FourNeighbours>(field, rules);
            }};
}

Method floats(const std::string& name, BaselineScheme scheme) {
    return {name, false, [=](const sand::HeightField& field, const sand::Rules& rules) -> std::unique_ptr<Relaxation> {
                return std::make_unique<Baseline>(scheme, field, rules);
            }};
}

}  // namespace

std::vector<Method> allMethods() {
    return {ours("G", sand::Scheme::isotropic, true),
            ours("G plain", sand::Scheme::plainIsotropic, true),
            ours("G plain full sweeps", sand::Scheme::plainIsotropic, false),
            fourNeighbours(),
            direct(),
            floats("float32 N4 in place", BaselineScheme::inPlaceN4),
            floats("float32 N4 Jacobi", BaselineScheme::jacobiN4),
            floats("float32 N8 Jacobi", BaselineScheme::jacobiN8),
            floats("float32 N8 sqrt2 Jacobi", BaselineScheme::jacobiN8r2)};
}

std::vector<Method> methods(const std::vector<std::string>& names) {
    const std::vector<Method> all = allMethods();
    std::vector<Method> chosen;
    for (const std::string& name : names) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const Method& m) { return m.name == name; });
        if (found == all.end()) {
            throw std::logic_error("there is no method with the name " + name);
        }
        chosen.push_back(*found);
    }
    return chosen;
}

sand::Rules rulesFor(const sand::HeightField& field, double talus, double band) {
    sand::Rules rules;
    rules.columns = field.columns();
    rules.rows = field.rows();
    rules.tuning.threshold = static_cast<std::int32_t>(std::lround(talus * sand::kUnitsPerCell));
    rules.tuning.startThreshold = static_cast<std::int32_t>(std::lround(talus * (1 + band) * sand::kUnitsPerCell));
    return rules;
}

std::int64_t sweepToRest(sand::HeightField& field, const sand::Rules& rules) {
    sand::grid::Erosion erosion(field, rules);
    erosion.sweep(field, kMostSweeps);
    return erosion.sweepsDone();
}

}  // namespace bench
