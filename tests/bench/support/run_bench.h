#pragma once

#include <exception>
#include <iostream>
#include <type_traits>

namespace vantage {

/// What a bench ends with: what its work says, 0 where that says nothing, 1 and the sentence of
/// what went wrong.
template <class Work>
int run_bench(const char* name, Work work) {
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
            work();
            return 0;
        } else {
            return work();
        }
    } catch (const std::exception& error) {
        std::cerr << name << ": " << error.what() << '\n';
        return 1;
    }
}

}  // namespace vantage
