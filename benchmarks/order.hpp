#pragma once

#include <string>

#include <motor/error.hpp>

/// The command line of a program of many runs:  [--quick] [--<one> NAME|all] --out DIR.
struct Order {
  bool quick = false;
  std::string wanted = "all";
  std::string directory;
};

/// Throws : kreisel::InvalidInput for any other call
inline Order parse_order(int argc, char** argv, const std::string& program,
                         const std::string& one) {
  Order order;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--quick") {
      order.quick = true;
    } else if (word == "--" + one && i + 1 < argc) {
      order.wanted = argv[++i];
    } else if (word == "--out" && i + 1 < argc) {
      order.directory = argv[++i];
    } else {
      throw kreisel::InvalidInput("no such option: " + word);
    }
  }
  if (order.directory.empty()) {
    throw kreisel::InvalidInput("usage: " + program + " [--quick] [--" + one +
                                " NAME|all] --out DIR");
  }
  return order;
}
