#pragma once

#include <string>

#include "common/base/error.h"

namespace vantage {

/// The sentence of the Error that `action` throws; empty if none. Other exceptions pass through.
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
