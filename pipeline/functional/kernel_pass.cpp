#include "pipeline/functional/kernel_pass.hpp"

#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/sample_planes.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace pipeline {

namespace {

constexpr std::uint32_t groups_at_a_time = 64; // bounds the memory of stores that wait

/// The targets of a kernel, which take one store for each texel.
class KernelTargets {
  public:
    KernelTargets(const Pass& pass, const KernelShape& shape, SurfaceStore& surfaces)
        : pass_(pass), shape_(shape), surfaces_(surfaces), writers_(pass.targets.size()) {
        for (std::size_t i = 0; i < pass.targets.size(); ++i)
            if (const SurfaceId surface = pass.targets[i]; surface != no_surface) {
                surfaces.clear(surface);
                writers_[i].assign(surfaces.places(surface), nobody);
            }
    }

    void put(const KernelStores& stores, std::uint32_t group) {
        for (const KernelStores::Store& store : stores.all()) put(store, group);
    }

  private:
    static constexpr std::uint32_t nobody = ~0U;

    void put(const KernelStores::Store& store, std::uint32_t group) {
        CHECK_MSG(store.target < shape_.targets, fmt::format("pass {}: {} stores to target {} of {}", pass_.name,
                                                             name_of(group), store.target, shape_.targets));
        if (store.target >= pass_.targets.size() || pass_.targets[store.target] == no_surface)
            return; // nobody reads it
        const SurfaceId surface = pass_.targets[store.target];
        const SurfaceInfo& info = surfaces_.info(surface);
        const auto place = [&] {
            return fmt::format("texel ({}, {}, {}) of {}", store.x, store.y, store.plane, info.name);
        };
        CHECK_MSG(store.x < info.width && store.y < info.height && store.plane < info.planes,
                  fmt::format("pass {}: {} stores {}, which it does not have", pass_.name, name_of(group), place()));
        const std::uint32_t row = store.plane * plane_rows(info.height, info.planes) + store.y;
        std::uint32_t& writer = writers_[store.target][std::size_t{row} * info.width + store.x];
        CHECK_MSG(writer == nobody, fmt::format("pass {}: {} and {} both store {}", pass_.name, name_of(writer),
                                                name_of(group), place()));
        writer = group;
        pack_colour(info.format, store.value, surfaces_.written(surface, {store.x, row, 0}));
    }

    std::string name_of(std::uint32_t group) const {
        return fmt::format("group ({}, {})", group % shape_.groups.x, group / shape_.groups.x);
    }

    const Pass& pass_;
    const KernelShape& shape_;
    SurfaceStore& surfaces_;
    std::vector<std::vector<std::uint32_t>> writers_; ///< by target and place
};

void check_kernel(const Pass& pass, const KernelShape& shape, const SurfaceStore& surfaces) {
    CHECK_MSG(pass.targets.size() <= shape.targets && pass.reads.size() == shape.reads,
              fmt::format("pass {}: {} targets and {} surfaces to read, and its kernel knows {} and {}", pass.name,
                          pass.targets.size(), pass.reads.size(), shape.targets, shape.reads));
    for (const SurfaceId surface : pass.reads)
        CHECK_MSG(std::find(pass.targets.begin(), pass.targets.end(), surface) == pass.targets.end(),
                  fmt::format("pass {}: it reads its target {}", pass.name, surfaces.info(surface).name));
}

} // namespace

void run_kernel(const Pass& pass, SurfaceStore& surfaces, unsigned threads) {
    const KernelShape shape = pass.kernel->shape();
    check_kernel(pass, shape, surfaces);
    KernelTargets targets(pass, shape, surfaces);
    const std::uint32_t groups = shape.groups.x * shape.groups.y;
    for (std::uint32_t first = 0; first < groups; first += groups_at_a_time) {
        std::vector<KernelStores> stores(std::min(groups_at_a_time, groups - first));
        parallel_for(threads, stores.size(), [&](std::size_t i) {
            const std::uint32_t group = first + static_cast<std::uint32_t>(i);
            SurfaceAccess access(surfaces, pass.reads);
            pass.kernel->run({group % shape.groups.x, group / shape.groups.x}, access, stores[i]);
        });
        for (std::uint32_t i = 0; i < stores.size(); ++i) targets.put(stores[i], first + i);
    }
}

} // namespace pipeline
