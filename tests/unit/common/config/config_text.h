#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {

/// Loads configurations from texts, by a function that takes a path.
template <auto load_file>
class ConfigText : public testing::Test {
  protected:
    auto load(const std::string& text) {
        std::ofstream(file_) << text;
        return load_file(file_);
    }
    /// What is wrong with `text`, without the folder of the file.
    std::string fault(const std::string& text) {
        std::string sentence = thrown_sentence([&] { load(text); });
        const std::string folder = folder_.path().string() + "/";
        if (sentence.starts_with(folder)) sentence.erase(0, folder.size());
        return sentence;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "config.toml";
};

}  // namespace vantage
