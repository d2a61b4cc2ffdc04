// Prints how the readers of rig.toml and stage.toml refuse files: a line each, empty for a file
// without a fault. tools/reference.py asks for types and ranges of keys with it.
//   config_sentences FILE...    files whose names begin with "rig" are read as rig.toml, others as
//   stage.toml
#include <cstdio>
#include <filesystem>
#include <string>

#include "common/base/error.h"
#include "common/config/rig_config.h"
#include "common/config/stage_config.h"

int main(int count, char** arguments) {
    for (int i = 1; i < count; ++i) {
        const std::filesystem::path file = arguments[i];
        std::string sentence;
        try {
            if (file.filename().string().starts_with("rig"))
                vantage::load_rig_config(file);
            else
                vantage::load_stage_config(file);
        } catch (const vantage::Error& error) {
            sentence = error.what();
        }
        std::puts(sentence.c_str());
    }
}
