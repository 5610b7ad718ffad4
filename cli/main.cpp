// The program: arguments to subcommand, outcome to exit status.
//   0 good   1 the input is bad   2 the arguments are no command   3 an error of ropsim itself   130, 143 interrupted
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <new>

namespace {

struct Dispatch {
    void operator()(const cli::CompareCommand& command) const { cli::compare(command); }
    void operator()(const cli::RunCommand& command) const { cli::run(command); }
    void operator()(const cli::TruthCommand& command) const { cli::truth(command); }
    void operator()(const cli::AccuracyCommand& command) const { cli::accuracy(command); }
    void operator()(const cli::GeometryCommand& command) const { cli::geometry(command); }
    void operator()(const cli::ValidateCommand& command) const { cli::validate(command); }
    void operator()(const cli::CalibrateCommand& command) const { cli::calibrate(command); }
    void operator()(const cli::StudyCommand& command) const { cli::study(command); }
    void operator()(const cli::SensitivityCommand& command) const { cli::sensitivity(command); }
    void operator()(const cli::StabilityCommand& command) const { cli::stability(command); }
    void operator()(const cli::DescribeCommand& command) const { cli::describe(command); }
    void operator()(const cli::ShowText& show) const { cli::print(show.text); }
};

int our_bug(const std::vector<std::string>& arguments, const char* what) {
    cli::complain(fmt::format("internal error: {}", what));
    cli::complain(fmt::format("this is a bug in ropsim {} ({}); please report it with the command: ropsim {}",
                              reports::version_text(), reports::build_text(), fmt::join(arguments, " ")));
    return 3;
}

int run_program(const std::vector<std::string>& arguments) {
    try {
        std::visit(Dispatch(), cli::parse_command_line(arguments));
        return 0;
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
        cli::complain("out of memory: a smaller --size or --k, fewer --designs or fewer --threads need less");
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
