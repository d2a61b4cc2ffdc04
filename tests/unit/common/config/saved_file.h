#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"

namespace vantage {

/// A file in a folder of its own, which a test damages.
class SavedFile : public testing::Test {
  protected:
    explicit SavedFile(const char* name) : file_(folder_.path() / name) {}

    std::string text() const {
        std::ostringstream out;
        out << std::ifstream(file_).rdbuf();
        return out.str();
    }
    void replace(const std::string& from, const std::string& to) {
        std::string content = text();
        const std::size_t at = content.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        content.replace(at, from.size(), to);
        std::ofstream(file_) << content;
    }
    /// Gives the first number of the key another value. OpenCV's releases write numbers in
    /// different forms.
    void set_number(const std::string& key, const std::string& value) {
        std::string content = text();
        const std::size_t at = content.find(key + ": ");
        ASSERT_NE(at, std::string::npos) << key;
        const std::size_t begin = at + key.size() + 2;
        content.replace(begin, content.find('\n', begin) - begin, value);
        std::ofstream(file_) << content;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_;
};

}  // namespace vantage
