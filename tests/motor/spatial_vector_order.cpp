#include <boost/test/unit_test.hpp>

#include <cmath>

#include <motor/spatial_vector_order.hpp>

using namespace kreisel;

namespace {

const Motor<> V{{1, 2, 3}, {4, 5, 6}};
const Motor<> F{{-7, 8, 9}, {10, -11, 12}};
using Six = SpatialVector<double>;

}  // namespace

BOOST_AUTO_TEST_SUITE(spatial_vector_order)

BOOST_AUTO_TEST_CASE(agrees_with_other_libraries) {
  BOOST_TEST((velocity_numbers(V, SpatialVectorOrder::angular_first) == Six(1, 2, 3, 4, 5, 6)));
  BOOST_TEST((velocity_numbers(V, SpatialVectorOrder::linear_first) == Six(4, 5, 6, 1, 2, 3)));
  BOOST_TEST((force_numbers(F, SpatialVectorOrder::angular_first) == Six(10, -11, 12, -7, 8, 9)));
  BOOST_TEST((force_numbers(F, SpatialVectorOrder::linear_first) == Six(-7, 8, 9, 10, -11, 12)));
}

BOOST_AUTO_TEST_CASE(preserves_numbers_and_power) {
  for (const SpatialVectorOrder order :
       {SpatialVectorOrder::angular_first, SpatialVectorOrder::linear_first}) {
    const Six v = velocity_numbers(V, order);
    const Six f = force_numbers(F, order);
    const Motor<> again = velocity_of(v, order);
    BOOST_TEST((again.resultant == V.resultant && again.moment == V.moment));
    const Motor<> force = force_of(f, order);
    BOOST_TEST((force.resultant == F.resultant && force.moment == F.moment));
    // In either order the scalar product of six numbers is the power.
    BOOST_TEST(v.dot(f) == V.resultant.dot(F.moment) + V.moment.dot(F.resultant));
  }
}

// A wheel that rolls along x, its centre at height 1 over the world's origin: the point of contact
// is at rest.
BOOST_AUTO_TEST_CASE(moves_vectors_to_the_origin) {
  const Vector3<double> centre(0, 0, 1);
  const Six cvel(0, 2, 0, 2, 0, 0);
  const Motor<> of_cvel = velocity_of_cvel(cvel, centre);
  BOOST_TEST((of_cvel.resultant == Vector3<double>(0, 2, 0)));
  BOOST_TEST(of_cvel.moment.norm() == 0);
  const Motor<> aligned = velocity_of_world_aligned(Six(2, 0, 0, 0, 2, 0), centre);
  BOOST_TEST((aligned.resultant == Vector3<double>(0, 2, 0)));
  BOOST_TEST(aligned.moment.norm() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
