// What all designs do alike: their name, their parameters, their row in the list.
#pragma once

#include "models/kbuffers/library.hpp"
#include "sim/described.hpp"

namespace models {

/// `Design` has static `name` and `text`, and takes its `Params`.
template <class Design, sim::Described Params>
class ConfiguredDesign : public pipeline::KBufferDesign {
  public:
    explicit ConfiguredDesign(const Params& params) : params_(params) {}

    std::string_view id() const override { return Design::name; }
    std::string_view summary() const override { return Design::text; }
    std::string refuses(const pipeline::ModifyProgram&) const override { return {}; }
    sim::DescribedRef parameters() const override { return sim::DescribedRef(params_); }
    /// Hardware that is there anyway.
    pipeline::AddedHardware area(const pipeline::ModifyProgram&, const pipeline::View&,
                                 const pipeline::GpuShape&) const override {
        return {};
    }

    static DesignInfo info() {
        return {Design::name, Design::text,
                [](sim::Config& config) -> std::unique_ptr<pipeline::KBufferDesign> {
                    Params params;
                    config.read(Design::name, params);
                    return std::make_unique<Design>(params);
                },
                [] { return sim::describe<Params>(Design::name); }};
    }

  protected:
    Params params_;
};

} // namespace models
