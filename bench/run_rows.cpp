#include "bench/run_rows.hpp"

#include <benchmark/benchmark.h>

#include "driver/world/origin.hpp"

namespace bounce {

int run_rows(int argc, char** argv, const std::function<void()>& add_rows) {
  const Origin origin = find_origin();
  benchmark::AddCustomContext("commit", origin.commit);
  benchmark::AddCustomContext("compiler", origin.compiler);
  benchmark::AddCustomContext("flags", origin.flags);
  benchmark::AddCustomContext("cpu", origin.cpu);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add_rows();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace bounce
