// The cost of a right-hand side in three forms: general, pruned, by hand. Refuses to time forms
// with different results; script/pruning adds the instructions.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>

#include "pruning/agreement.hpp"
#include "pruning/cases.hpp"

int main(int argc, char** argv) {
  const std::vector<pruning::Case> cases = pruning::all_cases();
  bool good = true;
  for (const pruning::Case& c : cases) {
    for (const pruning::Form& form : c.forms) {
      const double off = pruning::difference(form, c.forms[2]);
      if (!(off <= 1e-14)) {
        std::fprintf(stderr, "pruning: %s, %s and by hand differ by %.1e\n", c.name.c_str(),
                     form.name.c_str(), off);
        good = false;
      }
      benchmark::RegisterBenchmark((c.name + ": " + form.name).c_str(),
                                   [run = form.run](benchmark::State& state) {
                                     while (state.KeepRunningBatch(64)) run(64);
                                   });
    }
  }
  if (!good) return EXIT_FAILURE;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
