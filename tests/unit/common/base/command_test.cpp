#include "common/base/cli/command.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// A program with a command `double N` that fails for negative N, and `series add|sum|count`.
struct Outcome {
    int status = -1;
    std::string out, err;
};
Outcome run(std::vector<std::string> words) {
    const CommandEntry command{[](CLI::App& program) {
        auto* sub = program.add_subcommand("double", "Doubles a number.");
        auto number = std::make_shared<int>(0);
        sub->add_option("N", *number, "the number")->required();
        sub->add_option("--times,-t", *number, "how often")->type_name("{once,twice}");
        sub->callback([number] {
            if (*number < 0) fail("{} is negative; give 0 or more", *number);
            std::cout << 2 * *number << '\n';
        });
    }};
    const CommandEntry series{[](CLI::App& program) {
        auto* sub = program.add_subcommand("series", "Of numbers.");
        sub->require_subcommand(1);
        sub->add_subcommand("add", "Their sum.")->callback([] {
            StopSignal stop;
            kill(getpid(), SIGINT);
            stop.wait_for(std::chrono::seconds(10));
            std::cout << "so far\n";
        });
        sub->add_subcommand("sum", "Of all of them.")->callback([] {
            std::cout << "1 + 2 + ...\n";
            throw Undecided("the sum cannot be told: there is no end");
        });
        auto* count = sub->add_subcommand("count", "How many.");
        count->add_option("--first", "where to begin")->required();
        count->add_option_group("end", "where to end")->add_option("--last", "the last one");
    }};
    words.insert(words.begin(), "calculator");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    Outcome outcome;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    outcome.status =
        run_program({.name = "calculator",
                     .description = "Calculates.",
                     .commit = "abc123",
                     .libraries = "ZeroMQ 4"},
                    {command, series}, static_cast<int>(arguments.size()), arguments.data());
    outcome.out = testing::internal::GetCapturedStdout();
    outcome.err = testing::internal::GetCapturedStderr();
    return outcome;
}

TEST(RunProgram, PutsResultsOnStdoutAndNothingOnStderr) {
    const Outcome outcome = run({"double", "21"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "42\n");
    EXPECT_EQ(outcome.err, "");
}

TEST(RunProgram, ReportsAFaultInOneSentence) {
    const Outcome outcome = run({"double", "-1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "base_test: error: -1 is negative; give 0 or more\n");
}

TEST(RunProgram, DistinguishesUsageErrorsFromFaults) {
    const std::string head = "base_test: error: ";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{}, "A subcommand is required; calculator --help lists the options\n"},
        {{"duble", "1"},
         "calculator has no command 'duble'; the nearest is 'double'; calculator --help lists the "
         "commands\n"},
        {{"root"},
         "calculator has no command 'root'; the ones there are: double, series; calculator --help "
         "lists the commands\n"},
        {{"help", "duble"},
         "calculator has no command 'duble'; the nearest is 'double'; calculator --help lists the "
         "commands\n"},
        {{"help", "series", "cuont"},
         "calculator series has no command 'cuont'; the nearest is 'count'; calculator series "
         "--help lists the commands\n"},
        {{"series", "cuont"},
         "calculator series has no command 'cuont'; the nearest is 'count'; calculator series "
         "--help lists the commands\n"},
        {{"double"}, "N is required; calculator double --help lists the options\n"},
        {{"series", "count", "--fist", "3"},
         "calculator series count has no option '--fist'; the nearest is '--first'; calculator "
         "series count --help lists the options\n"},
        {{"series", "count", "--first", "3", "--lsat", "4"},
         "calculator series count has no option '--lsat'; the nearest is '--last'; calculator "
         "series count --help lists the options\n"},
        {{"double", "1", "--tims=4"},
         "calculator double has no option '--tims'; the nearest is '--times'; calculator double "
         "--help lists the options\n"},
        {{"double", "1", "--fast"},
         "calculator double has no option '--fast'; calculator double --help lists the options\n"},
        {{"double", "1", "-x"},
         "calculator double has no option '-x'; calculator double --help lists the options\n"}};
    for (const auto& [words, sentence] : cases) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err, head + sentence);
    }
    const Outcome not_a_number = run({"double", "-t", "-5", "x"});
    EXPECT_EQ(not_a_number.status, 2);
    EXPECT_NE(not_a_number.err.find("calculator double --help"), std::string::npos);
}

TEST(RunProgram, HelpIsAResult) {
    const Outcome outcome = run({"double", "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("the number"), std::string::npos);
    const Outcome help = run({"help", "double"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.out, outcome.out);
    EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
}

TEST(RunProgram, PrintsItsVersion) {
    const Outcome outcome = run({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out.rfind("calculator ", 0), 0u);
    EXPECT_NE(outcome.out.find(" (commit abc123)\nCalculates.\nwith ZeroMQ 4\n"), std::string::npos)
        << outcome.out;
}

TEST(RunProgram, CtrlCExitsWith130AndKeepsTheOutput) {
    std::signal(SIGINT, SIG_DFL);
    const Outcome outcome = run({"series", "add"});
    EXPECT_EQ(outcome.status, 130);
    EXPECT_EQ(outcome.out, "so far\n");
}

TEST(RunProgram, AnUndecidedResultHasItsOwnStatus) {
    const Outcome outcome = run({"series", "sum"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.out, "1 + 2 + ...\n");
    EXPECT_EQ(outcome.err, "base_test: error: the sum cannot be told: there is no end\n");
}

TEST(RunProgram, PrintsAManPageOfEveryCommandAndOption) {
    const Outcome outcome = run({"--man-page"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out.rfind(".TH CALCULATOR 1 ", 0), 0u);
    for (const char* part :
         {"calculator \\- Calculates.", ".SS calculator double\nDoubles a number.",
          "\nthe number (required)\n", "\\-\\-times", "\nhow often\n",
          ".SS calculator series count\nHow many.", "\\-\\-last", "\nthe last one\n"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in\n" << outcome.out;
    EXPECT_EQ(outcome.out.find(".SS calculator series count \n"), std::string::npos)
        << "a group of options is no command:\n"
        << outcome.out;
}

/// What bash offers for a line whose last word is being typed.
std::string completed(const std::string& script, const std::string& line) {
    const std::string command =
        "source /dev/stdin; words=(" + line +
        "); COMP_WORDS=(\"${words[@]}\"); COMP_CWORD=$((${#words[@]} - 1)); "
        "_calculator; echo \"${COMPREPLY[@]}\"";
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "calculator.bash";
    std::ofstream(file) << script;
    const std::string shell = "bash -c '" + command + "' <" + file.string();
    std::string text;
    FILE* pipe = ::popen(shell.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    EXPECT_EQ(::pclose(pipe), 0);
    return text;
}

TEST(RunProgram, PrintsAWorkingBashCompletion) {
    const Outcome outcome = run({"--bash-completion"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(completed(outcome.out, "calculator \"\""), "double series\n");
    EXPECT_EQ(completed(outcome.out, "calculator ser"), "series\n");
    EXPECT_EQ(completed(outcome.out, "calculator series \"\""), "add sum count\n");
    EXPECT_EQ(completed(outcome.out, "calculator series count --fi"), "--first\n");
    EXPECT_EQ(completed(outcome.out, "calculator series count --la"), "--last\n");
    EXPECT_EQ(completed(outcome.out, "calculator double 3 --ti"), "--times\n");
    EXPECT_EQ(completed(outcome.out, "calculator double 3 --times \"\""), "once twice\n");
    EXPECT_EQ(completed(outcome.out, "calculator double x"), "\n") << "files, by bash itself";
}

}  // namespace
}  // namespace vantage
