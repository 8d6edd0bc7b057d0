#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/model/terms.hpp>
#include <dynamics/solve/report.hpp>

/// A table of numbers that Python reads through the buffer protocol.
struct Table {
  std::vector<double> numbers = {};
  std::size_t rows = 0;
  std::size_t columns = 0;

  void add(const std::vector<double>& row) {
    numbers.insert(numbers.end(), row.begin(), row.end());
    columns = row.size();
    ++rows;
  }
};

/// Columns of a table that belong together: a coordinate of a body, the force of a joint.
struct Group {
  std::string kind;  ///< the attribute of Run: coordinates, rates, parts, ..
  std::string name;  ///< of the body, element, constraint or sensor
  std::string part;  ///< such as force; empty if the group is all of it
  std::size_t begin;
  std::size_t count;
};

/// A motion as Python gets it.
struct Motion {
  std::string title;
  std::string model;
  std::vector<std::string> columns;
  std::vector<Group> groups;
  std::vector<Group> part_groups;  ///< of the table `parts`: relative, guide, Coriolis
  Table rows = {};
  Table parts = {};
  std::vector<double> errors = {};
  double error_of_log = 0;
  std::vector<kreisel::Term> terms = {};
  kreisel::RunReport report = {};
};

/// The members of an ensemble as Python gets them.
struct Members {
  std::vector<std::string> keys;     ///< of the varied numbers
  std::vector<std::string> columns;  ///< of the ends
  Table varied = {};
  Table ends = {};  ///< NaN for members that failed
  std::vector<double> errors = {};
  std::vector<std::string> messages = {};  ///< empty unless the member failed
  std::size_t missed = 0;                  ///< members that did not reach the tolerance
};
