#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>

#include <dynamics/signal/signal.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

template <class Value>
[[nodiscard]] Value zero() {
  if constexpr (std::is_same_v<Value, double>) {
    return 0;
  } else {
    return Value::Zero();
  }
}

template <class Value>
[[nodiscard]] bool is_finite(const Value& value) {
  const Value none = value - value;
  return none == zero<Value>();
}

template <class Value>
void check(const typename Signal<Value>::Points& points, const std::string& what) {
  const auto refuse = [&what](const std::string& why) {
    throw InvalidInput("signal: " + what + " " + why);
  };
  if (points.empty()) refuse("are none");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [t, value] = points[i];
    const std::string number = std::to_string(i + 1);
    if (!std::isfinite(t) || !is_finite(value)) refuse("are not finite at number " + number);
    if (i > 0 && !(t > points[i - 1].first)) refuse("do not increase at number " + number);
  }
}

}  // namespace

/// sin(angle + n pi/2), for the angle without rounding.
template <class Value>
class Signal<Value>::Cycle {
 public:
  Cycle(const Term& term, double t) {
    const double way = term.frequency * t;
    const double angle = way + term.phase;
    const double added = angle - way;
    const double off =
        std::fma(term.frequency, t, -way) + ((way - (angle - added)) + (term.phase - added));
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    sine_ = s * std::cos(off) + c * std::sin(off);
    cosine_ = c * std::cos(off) - s * std::sin(off);
  }

  [[nodiscard]] double operator[](int n) const {
    const double size = n % 2 == 0 ? sine_ : cosine_;
    return n % 4 < 2 ? size : -size;
  }

 private:
  double sine_;
  double cosine_;
};

template <class Value>
Signal<Value>::Signal() : Signal(zero<Value>()) {}

template <class Value>
Signal<Value>::Signal(const Value& constant) : Signal(constant, zero<Value>(), {}) {}

template <class Value>
Signal<Value>::Signal(const Value& constant, const Value& rate, std::vector<Term> terms)
    : lines_{{0, constant, rate}}, terms_(std::move(terms)) {
  bool finite = is_finite(constant) && is_finite(rate);
  for (const Term& term : terms_) {
    finite = finite && is_finite(term.amplitude) && std::isfinite(term.frequency) &&
             std::isfinite(term.phase);
  }
  if (!finite) throw InvalidInput("signal: a number is not finite");
}

template <class Value>
Signal<Value> Signal<Value>::steps(const Points& points) {
  check<Value>(points, "steps");
  Signal result;
  for (const auto& [begin, value] : points) {
    if (value != result.lines_.back().value) result.lines_.push_back({begin, value, zero<Value>()});
  }
  result.jumps_ = result.lines_.size() > 1;
  return result;
}

template <class Value>
Signal<Value> Signal<Value>::broken_line(const Points& points) {
  check<Value>(points, "points");
  Signal result(points.front().second);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [begin, value] = points[i];
    const auto& [end, next] = points[i + 1];
    result.lines_.push_back({begin, value, (next - value) / (end - begin)});
  }
  if (points.size() > 1) {
    result.lines_.push_back({points.back().first, points.back().second, zero<Value>()});
  }
  return result;
}

template <class Value>
Signal<Value> Signal<Value>::polynomials(Polynomials<Value> pieces) {
  if (pieces.begins.empty() || pieces.terms == 0 ||
      pieces.coefficients.size() != pieces.begins.size() * pieces.terms) {
    throw InvalidInput("signal: the coefficients of polynomials do not fit their pieces");
  }
  Signal result;
  result.spline_ = std::make_shared<const Polynomials<Value>>(std::move(pieces));
  return result;
}

template <class Value>
Value Signal<Value>::derivative(double t, int order) const {
  const Line& line = line_at(t);
  Value sum = zero<Value>();
  if (order == 0) sum = line.value + (t - line.begin) * line.rate;
  if (order == 1) sum = line.rate;
  for (const Term& term : terms_) {
    const Cycle cycle(term, t);
    sum += (std::pow(term.frequency, order) * cycle[order]) * term.amplitude;
  }
  if (spline_) sum += spline_->derivative(t, order);
  return sum;
}

template <class Value>
void Signal<Value>::coefficients(double t, double h, std::span<Value> result) const {
  const Line& line = line_at(t);
  for (Value& coefficient : result) coefficient = zero<Value>();
  result[0] = line.value + (t - line.begin) * line.rate;
  if (result.size() > 1) result[1] = h * line.rate;
  for (const Term& term : terms_) {
    const Cycle cycle(term, t);
    double factor = 1;  // (frequency h)^n / n!
    for (std::size_t n = 0; n < result.size(); ++n) {
      result[n] += (factor * cycle[static_cast<int>(n)]) * term.amplitude;
      factor *= term.frequency * h / static_cast<double>(n + 1);
    }
  }
}

template <class Value>
std::vector<double> Signal<Value>::discontinuities() const {
  std::vector<double> times;
  for (std::size_t i = 1; i < lines_.size(); ++i) times.push_back(lines_[i].begin);
  return times;
}

template <class Value>
bool Signal<Value>::is_constant() const {
  return lines_.size() == 1 && lines_.front().rate == zero<Value>() && terms_.empty() && !spline_;
}

template <class Value>
double Signal<Value>::greatest_frequency() const {
  double greatest = 0;
  for (const Term& term : terms_) greatest = std::max(greatest, std::abs(term.frequency));
  return greatest;
}

template <class Value>
Signal<Value> Signal<Value>::scaled(double factor) const {
  Signal result = *this;
  for (Line& line : result.lines_) {
    line.value *= factor;
    line.rate *= factor;
  }
  for (Term& term : result.terms_) term.amplitude *= factor;
  if (spline_) {
    Polynomials<Value> pieces = *spline_;
    for (Value& coefficient : pieces.coefficients) coefficient *= factor;
    result.spline_ = std::make_shared<const Polynomials<Value>>(std::move(pieces));
  }
  return result;
}

template <class Value>
const typename Signal<Value>::Line& Signal<Value>::line_at(double t) const {
  std::size_t first = 0;
  std::size_t last = lines_.size() - 1;
  while (first < last) {
    const std::size_t middle = (first + last + 1) / 2;
    if (lines_[middle].begin <= t) {
      first = middle;
    } else {
      last = middle - 1;
    }
  }
  return lines_[first];
}

template <class Value>
void Polynomials<Value>::require(double t) const {
  const double slack = 1e-12 * std::max(std::abs(begins.front()), std::abs(end));
  if (t >= begins.front() - slack && t <= end + slack) return;
  std::ostringstream text;
  text.precision(10);
  text << "signal: t = " << t << " s lies outside [" << begins.front() << ", " << end
       << "] s, for which the signal is known";
  throw InvalidInput(text.str());
}

template <class Value>
Value Polynomials<Value>::derivative(double t, int order) const {
  require(t);
  const auto next = std::upper_bound(begins.begin() + 1, begins.end(), t);
  const auto piece = static_cast<std::size_t>(next - begins.begin()) - 1;
  const double s = t - begins[piece];
  const Value* const c = coefficients.data() + piece * terms;
  Value sum = 0 * c[0];
  for (std::size_t n = terms; n-- > static_cast<std::size_t>(order);) {
    double factor = 1;
    for (int i = 0; i < order; ++i) factor *= static_cast<double>(n) - i;
    sum = s * sum + factor * c[n];
  }
  return sum;
}

template struct Polynomials<double>;
template struct Polynomials<Vector3<double>>;
template class Signal<double>;
template class Signal<Vector3<double>>;

}  // namespace kreisel
