#include "common/base/cli/command.h"

#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include "common/base/cli/command_documents.h"
#include "common/base/cli/misfit_words.h"
#include "common/base/cli/stop_signal.h"
#include "common/base/cli/version.h"
#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr int words_do_not_fit = 2;
constexpr int cannot_be_told = 3;
/// 128 and the number of SIGINT, as shells say it.
constexpr int interrupted = 130;

std::string version_text(const ProgramFacts& facts) {
    std::string text = fmt::format("{} {}", facts.name, version());
    if (!facts.commit.empty()) text += fmt::format(" (commit {})", facts.commit);
    text += fmt::format("\n{}", facts.description);
    if (!facts.libraries.empty()) text += fmt::format("\nwith {}", facts.libraries);
    return text;
}

/// The words after the program's name; `help a b` becomes `a b --help`.
std::vector<std::string> words_of(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words[0] == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    }
    return words;
}

/// Keeps memory flat where things come and go for hours. Threads, such as those that compile
/// shaders, leave what they freed to the arena of their time, of which glibc has up to eight a
/// processor. And once a large block was freed glibc takes blocks of its size from arenas too,
/// where small ones that live on part them: pictures of encoders, of windows, of takes.
void bound_heap(bool returns_large_blocks) {
    constexpr int arenas = 2, large_bytes = 1 << 20, kept_bytes = 16 << 20;
    mallopt(M_ARENA_MAX, arenas);
    if (!returns_large_blocks) return;
    mallopt(M_MMAP_THRESHOLD, large_bytes);
    // glibc stops adapting this one too, and 128 KiB are gone and back with every picture.
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
        return StopSignal::was_interrupted() ? interrupted : 0;
    } catch (const CLI::CallForHelp& help) {
        // The parser has help for a command before it looks whether there is one.
        const std::string sentence = unknown_command_sentence(program, words);
        if (sentence.empty()) return program.exit(help);
        say_error(sentence);
        return words_do_not_fit;
    } catch (const CLI::Success& help_or_version) {
        return program.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        say_error(misfit_sentence(program, words, error.what()));
        return words_do_not_fit;
    } catch (const Undecided& error) {
        std::cout.flush();
        say_error(error.what());
        return cannot_be_told;
    } catch (const std::exception& error) {
        say_error(error.what());
        return StopSignal::was_interrupted() ? interrupted : 1;
    }
}

}  // namespace vantage
