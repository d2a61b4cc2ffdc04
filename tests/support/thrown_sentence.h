#pragma once

#include <string>

#include "common/base/error.h"

namespace vantage {

/// The sentence of the Error that `action` throws; empty if it throws none. Other exceptions pass.
template <class Action>
std::string thrown_sentence(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace vantage
