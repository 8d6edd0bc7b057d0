#include <algorithm>

#include <dynamics/file/name_keys.hpp>
#include <dynamics/file/quoted.hpp>

namespace kreisel::detail {

namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + in_quotes(name);
  return result.empty() ? "there are none" : "there are " + result;
}

}  // namespace

int index_of_name(Section& section, std::string_view key, const std::string& word,
                  const std::vector<std::string>& words, const char* what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  section.refuse(
      key, in_quotes(word) + " is no " + what + did_you_mean(word, words) + "; " + listed(words));
  return 0;
}

Vector3<double> named_point(Section& section, std::string_view key, const std::string& name,
                            const NamedPoints& known, const std::string& body) {
  if (const auto found = known.find(name); found != known.end()) return found->second;
  std::vector<std::string> words;
  for (const auto& [word, place] : known) words.push_back(word);
  section.refuse(key, in_quotes(name) + " is no point of body " + in_quotes(body) +
                          did_you_mean(name, words) + "; " + listed(words));
  return Vector3<double>::Zero();
}

}  // namespace kreisel::detail
