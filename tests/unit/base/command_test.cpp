#include "common/base/command.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// A program with a command `double N` that fails for negative N.
struct Outcome {
    int status = -1;
    std::string out, err;
};
Outcome run(std::vector<std::string> words) {
    const CommandEntry command{[](CLI::App& program) {
        auto* sub = program.add_subcommand("double", "Doubles a number.");
        auto number = std::make_shared<int>(0);
        sub->add_option("N", *number, "the number")->required();
        sub->callback([number] {
            if (*number < 0) fail("{} is negative; give 0 or more", *number);
            std::cout << 2 * *number << '\n';
        });
    }};
    words.insert(words.begin(), "calculator");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    Outcome outcome;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    outcome.status = run_program("calculator", "Calculates.", {command},
                                 static_cast<int>(arguments.size()), arguments.data());
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

TEST(RunProgram, SaysWhatWentWrongInOneSentence) {
    const Outcome outcome = run({"double", "-1"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "base_test: error: -1 is negative; give 0 or more\n");
}

TEST(RunProgram, TellsWordsThatDoNotFitFromWorkThatFailed) {
    for (const auto& words : std::vector<std::vector<std::string>>{
             {}, {"halve"}, {"double"}, {"double", "x"}, {"double", "1", "--fast"}}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_NE(outcome.err.find("calculator --help"), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

TEST(RunProgram, HelpIsAResult) {
    const Outcome outcome = run({"double", "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out.find("the number"), std::string::npos);
    EXPECT_EQ(run({"--version"}).status, 0);
}

}  // namespace
}  // namespace vantage
