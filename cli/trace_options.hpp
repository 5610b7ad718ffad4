// Options of the subcommands that write, run and read draw traces.
#pragma once

#include "cli/options.hpp"

#include <CLI/CLI.hpp>

namespace cli {

void add_capture(CLI::App& command, CaptureCommand& options);
void add_record(CLI::App& command, RecordCommand& options);
void add_import(CLI::App& command, ImportCommand& options);
void add_replay(CLI::App& command, ReplayCommand& options);
void add_trace(CLI::App& command, TraceCommand& options);

} // namespace cli
