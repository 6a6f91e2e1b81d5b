// Ceres TinySolver with automatic derivatives on the handed-over sets: prints set,seconds,evaluations,sum of squares for each start.

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

static const double kLower[6] = {0, 0, 0, 1e-5, 1, 0};
static const double kUpper[6] = {1, 100, 100, 10, 100, 100};

struct Row {
  double ln_f, lobe[2][3];
};

template <typename T>
T fresnel(const T& n, const T& kappa, double c) {
  using std::sqrt;
  const double s2 = 1 - c * c;
  const T alpha = n * n - kappa * kappa - s2;
  const T q = sqrt(alpha * alpha + 4.0 * n * n * kappa * kappa + 1e-300);
  // The larger of a and b first, the other from a b = n kappa.
  T a, b;
  if (alpha >= T(0)) {
    a = sqrt(0.5 * (q + alpha));
    b = n * kappa / a;
  } else {
    b = sqrt(0.5 * (q - alpha));
    a = n * kappa / b;
  }
  const T rs = ((a - c) * (a - c) + b * b) / ((a + c) * (a + c) + b * b);
  const T u = a * c - s2, v = a * c + s2, w = b * c;
  return 0.5 * rs * (1.0 + (u * u + w * w) / (v * v + w * w));
}

struct Residuals {
  const std::vector<Row>& rows;
  mutable int evaluations = 0;

  int NumResiduals() const { return static_cast<int>(rows.size()); }

  template <typename T>
  bool operator()(const T* u, T* residuals) const {
    using std::exp;
    using std::log;
    using std::sin;
    ++evaluations;
    T x[6];
    for (int k = 0; k < 6; ++k) {
      const T s = sin(u[k]);
      x[k] = kLower[k] + (kUpper[k] - kLower[k]) * s * s;
    }
    const T inverse_m2 = 1.0 / (x[3] * x[3]);
    for (size_t i = 0; i < rows.size(); ++i) {
      T f = x[0] / M_PI + 1e-300;
      for (int lobe = 0; lobe < 2; ++lobe) {
        const double* g = rows[i].lobe[lobe];
        f += x[1 + lobe] * fresnel(x[4], x[5], g[1]) * g[2] * exp(-g[0] * inverse_m2) * inverse_m2;
      }
      residuals[i] = log(f) - rows[i].ln_f;
    }
    return true;
  }
};

int main(int, char** arguments) {
  const std::string folder = arguments[1];
  std::vector<std::vector<double>> starts;
  std::ifstream start_file(folder + "/starts.txt");
  for (std::vector<double> x(6); start_file >> x[0] >> x[1] >> x[2] >> x[3] >> x[4] >> x[5];) starts.push_back(x);
  for (int set = 0; set < 3; ++set) {
    std::vector<Row> rows;
    std::ifstream file(folder + "/set" + std::to_string(set) + ".txt");
    for (Row r; file >> r.ln_f >> r.lobe[0][0] >> r.lobe[0][1] >> r.lobe[0][2] >> r.lobe[1][0] >> r.lobe[1][1] >> r.lobe[1][2];) rows.push_back(r);
    for (const auto& start : starts) {
      using Function = ceres::TinySolverAutoDiffFunction<Residuals, Eigen::Dynamic, 6>;
      Residuals residuals{rows};
      const auto begun = std::chrono::steady_clock::now();
      Function function(residuals);
      ceres::TinySolver<Function> solver;
      solver.options.max_num_iterations = 200;
      Eigen::Matrix<double, 6, 1> u;
      for (int k = 0; k < 6; ++k) u[k] = std::asin(std::sqrt((start[k] - kLower[k]) / (kUpper[k] - kLower[k])));
      solver.Solve(function, &u);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun;
      std::printf("%d,%.9g,%d,%.17g\n", set, elapsed.count(), residuals.evaluations, 2 * solver.summary.final_cost);
    }
  }
}
