#include <dynamics/study/precession_admissibility_defined.hpp>
#include <dynamics/study/precession_defined.hpp>
