#include "kernels/reference/fabric/totals.hpp"

namespace drogue::reference {

Sums sums(const std::vector<double>& mass, const Vector& gravity, const std::vector<Vector>& load,
          const std::vector<Vector>& x, const std::vector<Vector>& v) {
  Sums s;
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t next = (axis + 1) % 3, after = (axis + 2) % 3;
      const long double m = mass[i], here = x[i][axis], velocity = v[i][axis];
      s.kinetic += m * velocity * velocity / 2.0L;
      s.gravity -= m * gravity[axis] * here;
      if (!load.empty()) s.load -= load[i][axis] * here;
      s.momentum[axis] += m * velocity;
      s.angular_momentum[axis] += m * (static_cast<long double>(x[i][next]) * v[i][after] -
                                       static_cast<long double>(x[i][after]) * v[i][next]);
    }
  return s;
}

}  // namespace drogue::reference
