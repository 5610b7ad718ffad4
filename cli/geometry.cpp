// ropsim geometry: what limits the geometry feed of a scene, and what preparing its meshes would win.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/measuring.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/remarks.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"
#include "traces/gltf_export.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

namespace {

// Written first: a scene that cannot be written is known before anything is simulated.
std::string export_scene(const GeometryCommand& command) {
    if (command.export_to.empty()) return {};
    if (command.prepare.empty()) throw sim::InputError("--export: expected a --prepare whose outcome is to be written");
    const traces::PreparedScene prepared = traces::prepare_scene(traces::load_scene(command.scene), command.prepare);
    traces::export_glb(prepared.scene, command.export_to);
    return fmt::format("The prepared scene is {}\n", command.export_to);
}

} // namespace

void geometry(const GeometryCommand& command) {
    const reports::GeometryRequest request = request_of(command);
    const std::string exported = export_scene(command);
    Measuring measuring(command.fidelity, "1");
    const reports::GeometryAdvice advice = reports::advise(request, measuring.options());
    measuring.end();
    const auto document = reports::advice_json(advice);
    std::string written = exported;
    if (!command.directory.empty())
        written += write_tables(command.directory, "geometry.json", document, reports::advice_tables(advice), {});
    print_result(command.json, reports::result_text(document), reports::advice_text(advice, terminal_style()),
                 reports::each_once(advice.notes), written.empty() ? "" : "\n" + written);
}

} // namespace cli
