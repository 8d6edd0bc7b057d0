// Values that are set against a scene file: the same scene as if the file had them.

#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include <support/scene_text.hpp>

using namespace kreisel;

namespace {

const std::string text =
    "title = \"two\" # a comment\n[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n" +
    test::body("a", "{ kind = \"revolute\", axis = [0, 0, 1] }", "initial = { angle_deg = 10 }") +
    test::body("b.c", "{ kind = \"prismatic\", axis = [0, 0, 1] }", "parent = \"a\"") +
    "[solve]\nt_end = 4\n";

SolveRequest with(const std::vector<std::string>& words) {
  SolveRequest request;
  for (const std::string& word : words) request.settings.push_back(parse_setting("--set", word));
  return request;
}

SceneFile scene(const std::vector<std::string>& words) {
  return parse_scene(text, "s.toml", with(words));
}

std::string mistakes(const std::vector<std::string>& words) {
  try {
    (void)scene(words);
  } catch (const SceneMistakes& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scene_setting)

BOOST_AUTO_TEST_CASE(values_replace_those_of_the_file) {
  const SceneFile found =
      scene({"body.a.mass=3", "body[1].inertia[2]=0.6", "gravity.vector[0]=1e-3",
             "body.b.c.mass=5 kg", "title=plain text", "solve.t_end=\"2 s\""});
  BOOST_TEST(found.bodies[0].inertia.value.mass == 3);
  BOOST_TEST(found.bodies[1].inertia.value.tensor.matrix()(2, 2) == 0.6);
  BOOST_TEST(found.bodies[1].inertia.value.mass == 5);
  BOOST_TEST(std::get<UniformGravity<Guide>>(found.gravity).g == Vector3<double>(1e-3, 0, -9.81));
  BOOST_TEST(found.title == "plain text");
  BOOST_TEST(found.t_end == 2);
}

BOOST_AUTO_TEST_CASE(defaults_of_the_file_can_be_set) {
  const SceneFile found =
      scene({"body.a.initial.rate=0.5", "body.b.c.initial.displacement=0.1", "solve.method=taylor",
             "guide={kind=\"rotating\", angular_velocity=[0,0,1]}", "report.reactions=true",
             "guide.origin_acceleration=[1,0,0]"});
  BOOST_TEST(found.start[0].rates[0] == 0.5);
  BOOST_TEST(found.start[1].coordinates[0] == 0.1);
  BOOST_TEST((found.method == Method::taylor));
  BOOST_TEST(found.reactions);
  BOOST_TEST(std::get<scene_guide::Rotating>(found.guide[0]).origin_acceleration.x() == 1);
}

BOOST_AUTO_TEST_CASE(mistakes_name_setting_and_key) {
  const std::pair<std::string, std::string> cases[] = {
      {"body.a.mass=-1", "--set body.a.mass=-1: body 'a'.mass: -1 must not be below 0"},
      {"body.a.mas=1", "--set body.a.mas=1: body 'a'.mas: is no key here (did you mean 'mass'?)"},
      {"body.a.initial.angle=1", "body 'a'.initial.angle_deg: is given in radian too"},
      {"body.aa.mass=1", "body.aa.mass: there is no 'aa' in the file (did you mean 'a'?)"},
      {"body[2].mass=1", "body[2].mass: there is no '[2]' in the file"},
      {"gravity.vector[-1]=1", "there is no '[-1]' in the file"},
      {"gravity.vector.x=1", "there is no 'x' in the file"},
      {"solve..t_end=1", "there is no '.t_end' in the file"},
      {"body.=1", "--set body.=1: body.: is no key"},
      {"body.a.mass=[[1", "--set body.a.mass=[[1: is no TOML"},
      {"body.a.mass=it's", "--set body.a.mass=it's: is no TOML"},
      {"body.a.mass=1\nbody=2", "give one value"}};
  for (const auto& [word, reason] : cases) {
    const std::string found = mistakes({word});
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  // Those of the file come first.
  const SolveRequest request = with({"body.a.mass=-1", "solve.tolerance=2"});
  try {
    (void)parse_scene("titel = 1\n" + text, "s.toml", request);
  } catch (const SceneMistakes& error) {
    const std::string all = error.what();
    BOOST_TEST(all.starts_with("s.toml:1:1: titel: is no key here"), all);
    BOOST_TEST(std::count(all.begin(), all.end(), '\n') == 2, all);
  }
}

BOOST_AUTO_TEST_CASE(a_key_takes_one_value) {
  BOOST_TEST(mistakes({"body.a.mass=1", "body[0].mass=2"}).find("body[0].mass: is given twice") !=
             std::string::npos);
  BOOST_TEST(mistakes({"body.a.initial={}", "body.a.initial.angle=1"}) == "none");
}

BOOST_AUTO_TEST_CASE(deep_keys_and_values_are_refused) {
  std::string key = "a";
  for (int i = 0; i < 70; ++i) key += ".a";
  BOOST_TEST(mistakes({key + "=1"}).find("nested more than 64 deep") != std::string::npos);
  BOOST_TEST(mistakes({"a=" + std::string(70, '[')}).find("nested more than 64 deep") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(words_without_key_or_value_are_refused) {
  for (const char* const word : {"", "a", "=1", "a="}) {
    BOOST_CHECK_THROW((void)parse_setting("--set", word), InvalidInput);
  }
  BOOST_TEST(parse_setting("--set", "a.b=c=d").value == "c=d");
}

BOOST_AUTO_TEST_SUITE_END()
