/* Spectra's shift-invert solver on CHOLMOD's factor or Eigen's own, and Eigen's sparse Cholesky. C++ because they are.
 */
#include "bench/spectra.h"

#include "bench/cholmod_factor.h"

#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>

#include <memory>
#include <vector>

namespace
{
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Vector = Eigen::VectorXd;

Matrix lower_triangle(int32_t n, const int64_t *colptr, const int32_t *row, const double *val)
{
    const std::vector<int> first(colptr, colptr + n + 1);
    return Eigen::Map<const Matrix>(n, n, colptr[n], first.data(), row, val);
}

class Llt
{
  public:
    virtual ~Llt() = default;
    virtual bool compute(double sigma) = 0;
    virtual int64_t nnz() const = 0;
    virtual void apply(const double *x, double *y) = 0;
};

class EigenLlt : public Llt
{
  public:
    explicit EigenLlt(Matrix A) : A_(std::move(A))
    {
    }
    bool compute(double sigma) override
    {
        llt_.setShift(-sigma);
        llt_.compute(A_);
        return llt_.info() == Eigen::Success;
    }
    int64_t nnz() const override
    {
        return llt_.matrixL().nestedExpression().nonZeros();
    }
    void apply(const double *x, double *y) override
    {
        Eigen::Map<const Vector> in(x, A_.rows());
        Eigen::Map<Vector>(y, A_.rows()) = llt_.solve(in);
    }

  private:
    Matrix A_;
    Eigen::SimplicialLLT<Matrix, Eigen::Lower> llt_;
};

class CholmodLlt : public Llt
{
  public:
    explicit CholmodLlt(bench_cholmod *c) : c_(c)
    {
    }
    bool compute(double) override
    {
        return bench_cholmod_order(c_) && bench_cholmod_analyze(c_) && bench_cholmod_factorize(c_);
    }
    int64_t nnz() const override
    {
        return bench_cholmod_nnz(c_);
    }
    void apply(const double *x, double *y) override
    {
        bench_cholmod_apply(c_, x, y);
    }

  private:
    bench_cholmod *c_;
};

/* What SymEigsShiftSolver wants of a matrix. */
class Operation
{
  public:
    using Scalar = double;
    Operation(Llt &llt, int32_t n) : llt_(llt), n_(n)
    {
    }
    Eigen::Index rows() const
    {
        return n_;
    }
    Eigen::Index cols() const
    {
        return n_;
    }
    void set_shift(const double &)
    {
    }
    void perform_op(const double *x, double *y) const
    {
        llt_.apply(x, y);
    }

  private:
    Llt &llt_;
    int32_t n_;
};
} // namespace

struct bench_spectra_state {
    int32_t n = 0;
    std::unique_ptr<Llt> llt;
    Eigen::MatrixXd vectors;
};

bench_spectra_state *bench_spectra_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                          double sigma, const char *how)
{
    try {
        auto state = std::make_unique<bench_spectra_state>();
        state->n = n;
        if (std::string(how).find("cholmod") == std::string::npos) {
            state->llt = std::make_unique<EigenLlt>(lower_triangle(n, colptr, row, val));
        } else {
            bench_cholmod *c = bench_cholmod_create(n, colptr, row, val, sigma, how);
            if (c == nullptr) {
                return nullptr;
            }
            state->llt = std::make_unique<CholmodLlt>(c);
        }
        return state.release();
    } catch (const std::exception &) {
        return nullptr;
    }
}

bool bench_spectra_solve(bench_spectra_state *state, int32_t pairs, int32_t basis, double sigma, double tolerance,
                         double *lambda, int32_t *solves, int64_t *nnz)
{
    try {
        if (!state->llt->compute(sigma)) {
            return false;
        }
        *nnz = state->llt->nnz();
        Operation operation(*state->llt, state->n);
        Spectra::SymEigsShiftSolver<Operation> solver(operation, pairs, basis, sigma);
        solver.init();
        const auto found =
            solver.compute(Spectra::SortRule::LargestMagn, 1000, tolerance, Spectra::SortRule::SmallestAlge);
        *solves = static_cast<int32_t>(solver.num_operations());
        if (found < pairs) {
            return false;
        }
        const Vector values = solver.eigenvalues();
        state->vectors = solver.eigenvectors();
        std::copy(values.data(), values.data() + pairs, lambda);
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

const double *bench_spectra_vectors(const bench_spectra_state *state)
{
    return state->vectors.data();
}

struct bench_eigen_llt_state {
    Matrix A;
    double sigma = 0.0;
    Eigen::SimplicialLLT<Matrix, Eigen::Lower> llt;
};

bench_eigen_llt_state *bench_eigen_llt_create(int32_t n, const int64_t *colptr, const int32_t *row, const double *val,
                                              double sigma)
{
    try {
        auto state = std::make_unique<bench_eigen_llt_state>();
        state->A = lower_triangle(n, colptr, row, val);
        state->llt.setShift(-sigma);
        return state.release();
    } catch (const std::exception &) {
        return nullptr;
    }
}

bool bench_eigen_llt_analyze(bench_eigen_llt_state *state)
{
    state->llt.analyzePattern(state->A);
    return true;
}

bool bench_eigen_llt_factor(bench_eigen_llt_state *state)
{
    state->llt.factorize(state->A);
    return state->llt.info() == Eigen::Success;
}

bool bench_eigen_llt_solve(bench_eigen_llt_state *state, double *X, int32_t nrhs)
{
    Eigen::Map<Eigen::MatrixXd> all(X, state->A.rows(), nrhs);
    all = state->llt.solve(all).eval();
    return true;
}

int64_t bench_eigen_llt_nnz(const bench_eigen_llt_state *state)
{
    return state->llt.matrixL().nestedExpression().nonZeros();
}
