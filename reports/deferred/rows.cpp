#include "reports/deferred/validation.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <optional>

namespace reports {

namespace {

constexpr double least_value = 1e-9; ///< of a row, so that it has a logarithm

ValidationRow row_named(const PublishedDeferred& published, const std::string& name, const std::string& suffix) {
    const std::size_t space = name.find(' ');
    ValidationRow row;
    row.table = name.substr(0, space);
    row.row = (space == std::string::npos ? name : name.substr(space + 1)) + suffix;
    for (const DeferredNote& note : published.explanations)
        for (const std::string& begin : note.rows)
            if (row.key().starts_with(begin)) row.explanation = note.text;
    return row;
}

/// A number, and how far what was printed was rounded.
struct Inexact {
    double value = 0, half = 0;
};

/// Milliseconds of a frame of a column, published or of the model.
using Milliseconds = std::function<Inexact(const DeferredColumn&, std::uint32_t lights)>;

struct DerivedValue {
    std::string lights; ///< of which it speaks
    Inexact number;
};

Inexact less(const Inexact& a, const Inexact& b) { return {a.value - b.value, std::hypot(a.half, b.half)}; }

Inexact over(const Inexact& a, const Inexact& b) {
    return {a.value / b.value, std::abs(a.value / b.value) * std::hypot(a.half / a.value, b.half / b.value)};
}

class Derivation {
  public:
    Derivation(const PublishedDeferred& published, const DeferredDerived& derived, std::vector<std::uint32_t> lights)
        : derived_(derived),
          a_(published.column(derived.a)),
          b_(derived.b.empty() ? a_ : published.column(derived.b)),
          lights_(std::move(lights)) {}

    std::vector<DerivedValue> of(const Milliseconds& milliseconds) const {
        std::vector<DerivedValue> values;
        const bool steps = derived_.kind == DeferredKind::slope || derived_.kind == DeferredKind::slope_ratio;
        for (std::size_t i = 0; i + (steps ? 1 : 0) < lights_.size(); ++i) {
            const std::uint32_t here = lights_[i];
            const auto slope = [&](const DeferredColumn& column) {
                const std::uint32_t next = lights_[i + 1];
                return over(less(milliseconds(column, next), milliseconds(column, here)),
                            {static_cast<double>(next - here), 0});
            };
            Inexact number;
            switch (derived_.kind) {
            case DeferredKind::difference:
                number = less(milliseconds(b_, here), milliseconds(a_, here));
                break;
            case DeferredKind::per_light:
                number = over(less(milliseconds(b_, here), milliseconds(a_, here)), {static_cast<double>(here), 0});
                break;
            case DeferredKind::ratio:
                number = over(milliseconds(b_, here), milliseconds(a_, here));
                break;
            case DeferredKind::slope:
                number = slope(a_);
                break;
            case DeferredKind::slope_ratio:
                number = over(slope(a_), slope(b_));
                break;
            }
            values.push_back(
                {steps ? fmt::format(", {} to {} lights", here, lights_[i + 1]) : fmt::format(", {} lights", here),
                 number});
        }
        return derived_.spread ? spread_of(values) : values;
    }

    std::string unit() const {
        if (derived_.spread || derived_.kind == DeferredKind::ratio || derived_.kind == DeferredKind::slope_ratio)
            return "ratio";
        return derived_.kind == DeferredKind::difference ? "ms" : "ms/light";
    }

  private:
    static std::vector<DerivedValue> spread_of(const std::vector<DerivedValue>& values) {
        if (values.size() < 2) return {};
        double sum = 0, low = values.front().number.value, high = low;
        for (const DerivedValue& one : values) {
            sum += one.number.value;
            low = std::min(low, one.number.value);
            high = std::max(high, one.number.value);
        }
        return {{"", {(high - low) / (sum / static_cast<double>(values.size())), 0}}};
    }

    const DeferredDerived& derived_;
    const DeferredColumn &a_, &b_;
    std::vector<std::uint32_t> lights_;
};

class RowMaker {
  public:
    RowMaker(const PublishedDeferred& published, const DeferredRuns& runs) : published_(published), runs_(runs) {}

    void add(const DeferredColumn& column) {
        for (const std::uint32_t count : column.lights) {
            const auto run = runs_.find(column.with(count));
            if (run == runs_.end()) continue;
            ValidationRow row = row_named(published_, column.name, fmt::format(", {} lights", count));
            const PrintedNumber& printed = *column.measured(count);
            row.gpu = column.frame.gpu;
            row.low = row.high = printed.value;
            row.sigma = printed.sigma();
            row.model = 1e3 / run->second.milliseconds;
            row.limit = run->second.limit();
            row.host_seconds = run->second.host_seconds;
            if (!column.repeats.empty()) {
                row.status = RowStatus::derived;
                row.source = "that of " + column.repeats + " again";
            }
            if (column.name == published_.calibrated.column && count == published_.calibrated.lights) {
                row.status = RowStatus::calibrated;
                row.parameter = published_.calibrated.parameter;
            }
            rows_.push_back(std::move(row));
        }
    }

    void add(const DeferredDerived& derived) {
        const DeferredColumn& a = published_.column(derived.a);
        const DeferredColumn& b = derived.b.empty() ? a : published_.column(derived.b);
        std::vector<std::uint32_t> lights;
        for (const std::uint32_t count : a.lights) {
            const bool wanted = derived.lights.empty() ||
                                std::find(derived.lights.begin(), derived.lights.end(), count) != derived.lights.end();
            if (wanted && b.measured(count) != nullptr && runs_.contains(a.with(count)) &&
                runs_.contains(b.with(count)))
                lights.push_back(count);
        }
        const Derivation derivation(published_, derived, std::move(lights));
        const auto printed = derivation.of([](const DeferredColumn& column, std::uint32_t count) {
            const PrintedNumber& fps = *column.measured(count);
            return Inexact{1e3 / fps.value, 1e3 / fps.value * fps.sigma()};
        });
        const auto model = derivation.of([this](const DeferredColumn& column, std::uint32_t count) {
            return Inexact{runs_.at(column.with(count)).milliseconds, 0};
        });
        CHECK(printed.size() == model.size());
        for (std::size_t i = 0; i < model.size(); ++i) add(derived, derivation.unit(), a, printed[i], model[i]);
    }

    std::vector<ValidationRow> take() && { return std::move(rows_); }

  private:
    void add(const DeferredDerived& derived, const std::string& unit, const DeferredColumn& a,
             const DerivedValue& printed, const DerivedValue& model) {
        ValidationRow row = row_named(published_, derived.name, model.lights);
        row.gpu = a.frame.gpu;
        row.unit = unit;
        row.status = RowStatus::derived;
        row.origin = PublishedOrigin::derived;
        row.source = derived.high > 0 ? "a band of specification 003, section 7" : "from printed numbers";
        row.low = std::max(derived.high > 0 ? derived.low : printed.number.value, least_value);
        row.high = std::max(derived.high > 0 ? derived.high : printed.number.value, least_value);
        if (derived.high == 0 && printed.number.value > 0) row.sigma = printed.number.half / printed.number.value;
        row.model = std::max(model.number.value, least_value);
        rows_.push_back(std::move(row));
    }

    const PublishedDeferred& published_;
    const DeferredRuns& runs_;
    std::vector<ValidationRow> rows_;
};

} // namespace

std::vector<ValidationRow> deferred_rows(const PublishedDeferred& published, const DeferredRuns& runs) {
    RowMaker maker(published, runs);
    for (const DeferredColumn& column : published.columns) maker.add(column);
    for (const DeferredDerived& derived : published.derived) maker.add(derived);
    return std::move(maker).take();
}

} // namespace reports
