#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace vantage {

/// Keeps what is printed to stdout while it lives, for a file; stdout gets it when that ends.
class PrintedText {
  public:
    /// Throws Error if there is no room for a temporary file.
    PrintedText();
    ~PrintedText();
    PrintedText(const PrintedText&) = delete;
    PrintedText& operator=(const PrintedText&) = delete;

    /// What was printed until now.
    std::string text() const;

  private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> kept_;
    int stdout_;
};

}  // namespace vantage
