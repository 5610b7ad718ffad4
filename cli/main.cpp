// The program: arguments to subcommand, outcome to exit status.
//   0 good   1 the input is bad, or a trace faulty or different   2 the arguments are no command   3 an error of ropsim
//   itself   4 a check says no 130, 143 interrupted
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/out_of_memory.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <new>
#include <system_error>
#include <type_traits>

namespace {

// Of each subcommand its exit status, where it has one of its own.
struct Dispatch {
    int operator()(const cli::CompareCommand& command) const { return good(cli::compare, command); }
    int operator()(const cli::RunCommand& command) const { return good(cli::run, command); }
    int operator()(const cli::TruthCommand& command) const { return cli::truth(command); }
    int operator()(const cli::AccuracyCommand& command) const { return good(cli::accuracy, command); }
    int operator()(const cli::GeometryCommand& command) const { return good(cli::geometry, command); }
    int operator()(const cli::ValidateCommand& command) const { return good(cli::validate, command); }
    int operator()(const cli::CalibrateCommand& command) const { return good(cli::calibrate, command); }
    int operator()(const cli::StudyCommand& command) const { return good(cli::study, command); }
    int operator()(const cli::SensitivityCommand& command) const { return good(cli::sensitivity, command); }
    int operator()(const cli::StabilityCommand& command) const { return good(cli::stability, command); }
    int operator()(const cli::CaptureCommand& command) const { return good(cli::capture, command); }
    int operator()(const cli::RecordCommand& command) const { return good(cli::record, command); }
    int operator()(const cli::ImportCommand& command) const { return good(cli::import_frames, command); }
    int operator()(const cli::ReplayCommand& command) const { return good(cli::replay, command); }
    int operator()(const cli::TraceCommand& command) const { return cli::trace(command); }
    int operator()(const cli::DescribeCommand& command) const { return good(cli::describe, command); }
    int operator()(const cli::ShowText& show) const { return good(cli::print, std::string_view(show.text)); }

  private:
    template <class Argument>
    static int good(void (*command)(Argument), std::type_identity_t<Argument> argument) {
        command(argument);
        return cli::status_good;
    }
};

int our_bug(const std::vector<std::string>& arguments, const char* what) {
    cli::complain(fmt::format("internal error: {}", what));
    cli::complain(fmt::format("this is a bug in ropsim {} ({}); please report it with the command: ropsim {}",
                              reports::version_text(), reports::build_text(), fmt::join(arguments, " ")));
    return 3;
}

int run_program(const std::vector<std::string>& arguments) {
    try {
        return std::visit(Dispatch(), cli::parse_command_line(arguments));
    } catch (const cli::UsageError& error) {
        cli::complain(error.what());
        return 2;
    } catch (const sim::InputError& error) {
        cli::complain(error.what());
        return 1;
    } catch (const sim::Interrupted&) {
        cli::tell_interrupted();
        return cli::interrupted_status();
    } catch (const std::bad_alloc&) {
        cli::complain(cli::out_of_memory_text());
        return 1;
    } catch (const std::system_error& error) {
        // No room for the stack of a thread.
        const bool no_room =
            error.code() == std::errc::resource_unavailable_try_again || error.code() == std::errc::not_enough_memory;
        if (!no_room) return our_bug(arguments, error.what());
        cli::complain(cli::out_of_memory_text());
        return 1;
    } catch (const std::exception& error) {
        return our_bug(arguments, error.what());
    }
}

} // namespace

int main(int count, char** arguments) {
    cli::catch_interruptions();
    return run_program(std::vector<std::string>(arguments + 1, arguments + count));
}
