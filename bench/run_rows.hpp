// The main function of a benchmark.
#pragma once

#include <functional>

namespace bounce {

/// Adds the rows, and runs those that the command line asks for, with their origin. The exit code.
int run_rows(int argc, char** argv, const std::function<void()>& add_rows);

}  // namespace bounce
