// Options that several subcommands share: what is drawn, how, and seen from where.
#pragma once

#include "cli/options.hpp"
#include "traces/workloads.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace cli {

void add_scene(CLI::App& command, std::string& scene);
void add_size(CLI::App& command, std::string& size);
void add_camera(CLI::App& command, std::string& camera);
void add_threads(CLI::App& command, std::string& threads);
void add_workload(CLI::App& command, std::string& workload, const std::string& text);
/// The options that workloads declare, but for those whose name the command already uses for something else.
void add_parameters(CLI::App& command, ParameterValues& values);
void add_settings(CLI::App& command, std::vector<std::string>& settings, const std::string& text);
/// What is drawn, how, and seen from where.
void add_frame(CLI::App& command, FrameOptions& options);
/// GPU, seed and threads.
void add_machine(CLI::App& command, FrameOptions& options);
/// All of the above.
void add_frame_options(CLI::App& command, FrameOptions& options);
/// Of comparisons.
void add_designs(CLI::App& command, CompareCommand& options);
void add_output_options(CLI::App& command, OutputOptions& options);

/// Of workloads: "a, b, c".
std::string ids_of(bool (*which)(const traces::Workload&));
/// What can be averaged, by workload.
std::string averaged_frames();
/// `help` with the examples of a command that workloads declare behind its own.
std::string with_examples(std::string help, const std::string& command);

} // namespace cli
