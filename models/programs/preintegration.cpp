#include "models/programs/preintegration.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace models {

namespace {

/// Steps of the integration for each linear piece of the transfer function.
constexpr int steps_per_piece = 32;

struct Sample {
    glm::dvec3 colour{0.0};
    double extinction = 0.0;
};

void check(const TransferFunction& transfer) {
    if (transfer.empty()) throw sim::InputError("transfer function: expected at least one point, got none");
    for (std::size_t i = 0; i < transfer.size(); ++i) {
        const TransferPoint& point = transfer[i];
        const auto complain = [i](std::string_view expected, float got) {
            throw sim::InputError(fmt::format("transfer function: point {}: expected {}, got {}", i, expected, got));
        };
        if (!std::isfinite(point.scalar) || (i > 0 && !(point.scalar > transfer[i - 1].scalar)))
            complain("a scalar greater than the one before", point.scalar);
        if (!std::isfinite(point.extinction) || point.extinction < 0.0F)
            complain("an extinction of at least 0", point.extinction);
        for (int channel = 0; channel < 3; ++channel)
            if (!std::isfinite(point.colour[channel])) complain("a finite colour", point.colour[channel]);
    }
}

Sample at(const TransferFunction& transfer, double scalar) {
    const auto above = std::upper_bound(transfer.begin(), transfer.end(), scalar, [](double s, const TransferPoint& p) {
        return s < static_cast<double>(p.scalar);
    });
    const TransferPoint& right = above == transfer.end() ? transfer.back() : *above;
    const TransferPoint& left = above == transfer.begin() ? transfer.front() : *(above - 1);
    const double width = static_cast<double>(right.scalar) - static_cast<double>(left.scalar);
    const double t = width > 0.0 ? (scalar - static_cast<double>(left.scalar)) / width : 0.0;
    const glm::dvec3 from(left.colour), to(right.colour);
    const double thin = static_cast<double>(left.extinction), thick = static_cast<double>(right.extinction);
    return {from + t * (to - from), thin + t * (thick - thin)};
}

/// Places along the gap, from 0 to 1, between which colour and extinction are linear, each piece cut in steps.
std::vector<double> places(const TransferFunction& transfer, double s1, double s2) {
    std::vector<double> pieces{0.0};
    for (const TransferPoint& point : transfer) {
        const double s = static_cast<double>(point.scalar);
        if (s > std::min(s1, s2) && s < std::max(s1, s2)) pieces.push_back((s - s1) / (s2 - s1));
    }
    pieces.push_back(1.0);
    std::sort(pieces.begin(), pieces.end());
    std::vector<double> result{0.0};
    for (std::size_t i = 1; i < pieces.size(); ++i)
        for (int step = 1; step <= steps_per_piece; ++step)
            result.push_back(pieces[i - 1] + (pieces[i] - pieces[i - 1]) * step / steps_per_piece);
    return result;
}

/// (1 - exp(-x) (1 + x)) / x: the weight of a step's far end, when colour is linear in the optical depth x; `opacity`
/// is 1 - exp(-x). The difference cancels for thin steps, where the first terms of its series are as good as a double.
double far_weight(double x, double opacity) {
    if (x < 1e-3) return x * (0.5 - x * (1.0 / 3.0 - x * (0.125 - x / 30.0)));
    return (opacity - x * (1.0 - opacity)) / x;
}

/// What is seen of one gap; samples are shared by all lengths.
class Gap {
  public:
    Gap(const TransferFunction& transfer, double s1, double s2) : places_(places(transfer, s1, s2)) {
        for (const double place : places_) samples_.push_back(at(transfer, s1 + place * (s2 - s1)));
        for (std::size_t i = 1; i < places_.size(); ++i) mean_extinction_ += depth_of_step(i);
    }

    glm::vec4 node(double length) const {
        if (mean_extinction_ * length == 0.0) return glm::vec4(thin_colour(), static_cast<float>(mean_extinction_));
        glm::dvec3 seen(0.0);
        double through = 1.0;
        for (std::size_t i = 1; i < places_.size(); ++i) {
            const double depth = depth_of_step(i) * length;
            const double opacity = -std::expm1(-depth);
            const glm::dvec3 near = samples_[i - 1].colour, far = samples_[i].colour;
            seen += through * (near * opacity + (far - near) * far_weight(depth, opacity));
            through *= 1.0 - opacity;
        }
        const glm::dvec3 mean = seen / -std::expm1(-mean_extinction_ * length);
        return glm::vec4(within(mean), static_cast<float>(mean_extinction_));
    }

  private:
    /// Optical depth of step i for a gap of length 1; the extinction is linear in it.
    double depth_of_step(std::size_t i) const {
        return 0.5 * (samples_[i - 1].extinction + samples_[i].extinction) * (places_[i] - places_[i - 1]);
    }

    /// The limit for small lengths: every part is seen, weighted by its extinction, or alike where there is none.
    glm::vec3 thin_colour() const {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t i = 1; i < places_.size(); ++i) {
            const double weight = mean_extinction_ > 0.0 ? depth_of_step(i) : places_[i] - places_[i - 1];
            sum += weight * 0.5 * (samples_[i - 1].colour + samples_[i].colour);
            weights += weight;
        }
        return within(sum / weights);
    }

    /// A mean lies between its terms, whatever the rounding: what is constant stays what it is.
    glm::vec3 within(glm::dvec3 mean) const {
        glm::dvec3 least = samples_.front().colour, most = least;
        for (const Sample& sample : samples_) {
            least = glm::min(least, sample.colour);
            most = glm::max(most, sample.colour);
        }
        return glm::vec3(glm::clamp(mean, least, most));
    }

    std::vector<double> places_;
    std::vector<Sample> samples_;
    double mean_extinction_ = 0.0;
};

/// Cell and place in it, for a coordinate of [0,1] on `nodes` nodes.
struct Cell {
    Cell(float coordinate, std::uint32_t nodes) {
        const float scaled = std::clamp(coordinate, 0.0F, 1.0F) * static_cast<float>(nodes - 1);
        first = std::min(static_cast<std::uint32_t>(scaled), nodes - 2);
        share = scaled - static_cast<float>(first);
    }
    std::uint32_t first;
    float share;
};

glm::vec4 between(glm::vec4 a, glm::vec4 b, float share) { return a + share * (b - a); }

} // namespace

PreintegratedTable::PreintegratedTable(const TransferFunction& transfer, float longest, std::uint32_t scalars,
                                       std::uint32_t lengths)
    : transfer_(transfer), longest_(longest), scalars_(scalars), lengths_(lengths) {
    check(transfer);
    if (!std::isfinite(longest) || !(longest > 0.0F))
        throw sim::InputError(fmt::format("pre-integrated table: expected a longest gap above 0, got {}", longest));
    for (const std::uint32_t nodes : {scalars, lengths})
        if (nodes < 2 || nodes > 256)
            throw sim::InputError(fmt::format("pre-integrated table: expected 2 to 256 nodes a side, got {}", nodes));
    first_ = transfer.front().scalar;
    range_ = transfer.back().scalar - first_;
    if (!std::isfinite(range_))
        throw sim::InputError("transfer function: expected scalars whose difference is a finite float");
}

void PreintegratedTable::integrate() const {
    const auto scalar = [&](std::uint32_t node) {
        return static_cast<double>(first_) + static_cast<double>(range_) * node / (scalars_ - 1);
    };
    nodes_.resize(std::size_t{scalars_} * scalars_ * lengths_);
    for (std::uint32_t s2 = 0; s2 < scalars_; ++s2)
        for (std::uint32_t s1 = 0; s1 < scalars_; ++s1) {
            const Gap gap(transfer_, scalar(s1), scalar(s2));
            for (std::uint32_t i = 0; i < lengths_; ++i)
                nodes_[(std::size_t{i} * scalars_ + s2) * scalars_ + s1] =
                    gap.node(static_cast<double>(longest_) * i / (lengths_ - 1));
        }
}

glm::vec4 PreintegratedTable::lookup(float s1, float s2, float length) const {
    const auto coordinate = [this](float s) { return range_ > 0.0F ? (s - first_) / range_ : 0.0F; };
    const Cell a(coordinate(s1), scalars_), b(coordinate(s2), scalars_);
    const Cell c(length / longest_, lengths_);
    const auto row = [&](std::uint32_t node_c, std::uint32_t node_b) {
        const glm::vec4* nodes = nodes_.data() + (std::size_t{node_c} * scalars_ + node_b) * scalars_ + a.first;
        return between(nodes[0], nodes[1], a.share);
    };
    const auto slice = [&](std::uint32_t node_c) {
        return between(row(node_c, b.first), row(node_c, b.first + 1), b.share);
    };
    return between(slice(c.first), slice(c.first + 1), c.share);
}

glm::vec4 PreintegratedTable::gap(float s1, float s2, float length) const {
    std::call_once(integrated_, [this] { integrate(); });
    const glm::vec4 node = lookup(s1, s2, length);
    const float opacity = -std::expm1(-node.a * length);
    return {opacity * glm::vec3(node), opacity};
}

} // namespace models
