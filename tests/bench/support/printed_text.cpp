#include "tests/bench/support/printed_text.h"

#include <unistd.h>

#include "common/base/error.h"

namespace vantage {

PrintedText::PrintedText() : kept_(std::tmpfile(), &std::fclose), stdout_(-1) {
    if (!kept_) fail("no temporary file could be made for the tables; free some space in /tmp");
    std::fflush(stdout);
    stdout_ = dup(STDOUT_FILENO);
    if (stdout_ < 0 || dup2(fileno(kept_.get()), STDOUT_FILENO) < 0)
        fail("the program's output could not be kept: too many files are open");
}

PrintedText::~PrintedText() {
    const std::string printed = text();
    dup2(stdout_, STDOUT_FILENO);
    close(stdout_);
    std::fwrite(printed.data(), 1, printed.size(), stdout);
    std::fflush(stdout);
}

std::string PrintedText::text() const {
    std::fflush(stdout);
    std::string result;
    std::fseek(kept_.get(), 0, SEEK_SET);
    for (int c = 0; (c = std::fgetc(kept_.get())) != EOF;) result += static_cast<char>(c);
    std::fseek(kept_.get(), 0, SEEK_END);
    return result;
}

}  // namespace vantage
