#include "common/base/cli/command.h"

#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include "common/base/cli/command_documents.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr int status_usage_error = 2;
constexpr int status_undecided = 3;
/// 128 plus the number of SIGINT, as shells report it.
constexpr int status_interrupted = 130;

std::string version_text(const ProgramFacts& facts) {
    std::string text = fmt::format("{} {}", facts.name, version());
    if (!facts.commit.empty()) text += fmt::format(" (commit {})", facts.commit);
    text += fmt::format("\n{}", facts.description);
    if (!facts.libraries.empty()) text += fmt::format("\nwith {}", facts.libraries);
    return text;
}

/// The arguments after the program's name. `help a b` becomes `a b --help`.
std::vector<std::string> words_of(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words[0] == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    }
    return words;
}

/// Keeps memory use constant over hours of operation. Each thread leaves freed blocks in an arena
/// of its own, and glibc creates up to eight arenas per processor. After a large block was freed,
/// glibc also serves blocks of that size from arenas, where small long-lived blocks fragment them;
/// encoders, windows and takes allocate frames of that size.
void bound_heap(bool returns_large_blocks) {
    constexpr int arenas = 2, large_bytes = 1 << 20, kept_bytes = 16 << 20;
    mallopt(M_ARENA_MAX, arenas);
    if (!returns_large_blocks) return;
    mallopt(M_MMAP_THRESHOLD, large_bytes);
    // Setting a limit stops glibc from adapting it; at the default of 128 KiB the memory of
    // every frame would go back to the system and be requested again.
    mallopt(M_TRIM_THRESHOLD, kept_bytes);
}

}  // namespace

int run_program(const ProgramFacts& facts, const std::vector<CommandEntry>& commands, int argc,
                char** argv) {
    bound_heap(facts.returns_large_blocks);
    CLI::App program{std::string(facts.description), std::string(facts.name)};
    program.require_subcommand(1);
    program.set_version_flag("--version", version_text(facts));
    for (const CommandEntry& command : commands) command.add(program);
    const std::vector<std::string> words = words_of(argc, argv);
    if (words == std::vector<std::string>{"--man-page"}) {
        std::cout << man_page(program, version());
        return 0;
    }
    if (words == std::vector<std::string>{"--bash-completion"}) {
        std::cout << bash_completion(program);
        return 0;
    }
    try {
        program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
        std::cout.flush();
        if (!std::cout) fail("standard output could not be written");
        return StopSignal::was_interrupted() ? status_interrupted : 0;
    } catch (const CLI::CallForHelp& help) {
        // CLI11 answers --help before it checks that the command exists.
        const std::string sentence = unknown_command_sentence(program, words);
        if (sentence.empty()) return program.exit(help);
        say_error(sentence);
        return status_usage_error;
    } catch (const CLI::Success& help_or_version) {
        return program.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        say_error(misfit_sentence(program, words, error.what()));
        return status_usage_error;
    } catch (const Undecided& error) {
        std::cout.flush();
        say_error(error.what());
        return status_undecided;
    } catch (const std::exception& error) {
        say_error(error.what());
        return StopSignal::was_interrupted() ? status_interrupted : 1;
    }
}

}  // namespace vantage
