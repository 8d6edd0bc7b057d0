#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <dynamics/ensemble/scene_ensemble.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>

namespace kreisel {

namespace {

/// A number in TOML, exact to the last bit. Integers of TOML have 64 bits.
std::string toml_number(double x) {
  std::array<char, 32> digits{};
  char* const begin = digits.data();
  char* const end = begin + digits.size();
  const auto written = std::abs(x) < 1e15
                           ? std::to_chars(begin, end, x)
                           : std::to_chars(begin, end, x, std::chars_format::scientific);
  return {begin, written.ptr};
}

}  // namespace

SceneEnsemble::SceneEnsemble(std::string text, std::filesystem::path path, EnsembleRequest request)
    : text_(std::move(text)),
      path_(std::move(path)),
      request_(std::move(request)),
      scene_(parse_scene(text_, path_, request_.solve)) {
  for (const Variation& variation : request_.variations) {
    for (const std::string& key : variation.keys) {
      keys_.push_back(key);
      given_.push_back(number_in_scene(text_, key));
      if (given_.back() || variation.use == Variation::Use::instead) continue;
      throw InvalidInput("--vary " + variation.text + ": the file has no number at " + key +
                         ": vary it with = alone");
    }
  }
  // Reports mistakes that all members share.
  std::vector<double> numbers = varied(0);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = given_[i].value_or(numbers[i]);
  (void)make_model(parse_scene(text_, path_, with(numbers)));
  scene_.reactions = false;
  scene_.element_forces = false;
  scene_.constraint_forces = false;
  columns_ = kreisel::columns(scene_);
  columns_.erase(columns_.begin());  // the time
}

std::vector<double> SceneEnsemble::varied(std::size_t index) const {
  MemberRandom random(request_.seed, index);
  const auto last = static_cast<double>(request_.members - 1);
  const double share = last > 0 ? static_cast<double>(index) / last : 0;
  std::vector<double> numbers;
  for (const Variation& variation : request_.variations) {
    const double drawn = variation.drawn(share, random);
    for (std::size_t k = 0; k < variation.keys.size(); ++k) {
      numbers.push_back(variation.applied(given_[numbers.size()].value_or(0), drawn));
    }
  }
  return numbers;
}

SolveRequest SceneEnsemble::with(const std::vector<double>& numbers) const {
  SolveRequest solve = request_.solve;
  std::size_t i = 0;
  for (const Variation& variation : request_.variations) {
    for (const std::string& key : variation.keys) {
      solve.settings.push_back({key, toml_number(numbers[i++]), "--vary " + variation.text});
    }
  }
  return solve;
}

SceneMember SceneEnsemble::member(std::size_t index, const std::stop_token& stop) const {
  SceneMember member;
  member.varied = varied(index);
  try {
    SceneFile file = parse_scene(text_, path_, with(member.varied));
    for (SceneSensor& sensor : file.sensors) {
      if (sensor.errors) sensor.errors->seed += index;  // each member has its own noise
    }
    const auto model = make_model(file);
    SolveOptions options = options_of(file);
    options.stop = stop;
    const auto run = model->solve(options, start_of(file));
    member.status = run.report.status;
    member.message = run.report.message;
    if (run.report.status != RunStatus::complete) return member;
    member.end = row(*model, file.t_end, run.states.back(), {});
    member.end.erase(member.end.begin());
    const std::vector<double> readings = SensorReadings(file).last_row(*model, run);
    member.end.insert(member.end.end(), readings.begin(), readings.end());
    member.error = run.report.error_estimate;
    member.tolerance_kept = run.report.tolerance_kept;
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!finite(member.error) || !std::all_of(member.end.begin(), member.end.end(), finite)) {
      member.status = RunStatus::failed;
      member.message = "the end of the motion or its error is not finite";
    }
  } catch (const std::exception& error) {
    if (stop.stop_requested()) return member;  // cancelled
    member.status = RunStatus::failed;
    member.message = error.what();  // several lines for a scene
    std::replace(member.message.begin(), member.message.end(), '\n', ';');
  }
  return member;
}

std::vector<SceneMember> SceneEnsemble::compute(const Workers& workers) const {
  std::vector<SceneMember> members(request_.members);
  (void)parallel_for(members.size(), workers, [&](std::size_t i, const std::stop_token& stop) {
    members[i] = member(i, stop);
  });
  return members;
}

void ColumnSpread::add(double x) {
  count += 1;
  const double off = x - mean;
  mean += off / count;
  squares += off * (x - mean);
  least = std::min(least, x);
  greatest = std::max(greatest, x);
}

double ColumnSpread::deviation() const { return std::sqrt(squares / std::max(1.0, count - 1)); }

EnsembleSummary summary(const SceneEnsemble& ensemble, const std::vector<SceneMember>& members) {
  EnsembleSummary result;
  for (const std::string& key : ensemble.keys()) result.columns.push_back({key});
  for (const std::string& name : ensemble.columns()) result.columns.push_back({name});
  for (std::size_t i = 0; i < members.size(); ++i) {
    const SceneMember& member = members[i];
    if (member.status == RunStatus::failed && result.failed++ == 0) {
      result.message = "member " + std::to_string(i) + ": " + member.message;
    }
    if (member.status != RunStatus::complete) continue;
    ++result.complete;
    if (!member.tolerance_kept) ++result.off;
    result.error = std::max(result.error, member.error);
    auto column = result.columns.begin();
    for (const double x : member.varied) (column++)->add(x);
    for (const double x : member.end) (column++)->add(x);
  }
  return result;
}

}  // namespace kreisel
