#include "linear_algebra.h"

#include <lapacke.h>
#include <math.h>

bool cholesky_factor(size_t n, double *a) { return LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (lapack_int)n, a, (lapack_int)n) == 0; }

void cholesky_solve(size_t n, const double *l, size_t count, double *b)
{
    LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', (lapack_int)n, (lapack_int)count, l, (lapack_int)n, b, (lapack_int)n);
}

void triangle_solve(size_t n, const double *l, size_t count, double *b)
{
    LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'L', 'N', 'N', (lapack_int)n, (lapack_int)count, l, (lapack_int)n, b, (lapack_int)n);
}

bool cholesky_invert(size_t n, double *l) { return LAPACKE_dpotri(LAPACK_COL_MAJOR, 'L', (lapack_int)n, l, (lapack_int)n) == 0; }

bool symmetric_eigen(size_t n, double *a, double *values)
{
    if (LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (lapack_int)n, a, (lapack_int)n, values) != 0) return false;
    for (size_t v = 0; v < n; v++) {
        double largest = 0.0;
        for (size_t i = 0; i < n; i++)
            if (fabs(a[v * n + i]) > fabs(largest) * (1.0 + 1e-9)) largest = a[v * n + i];
        for (size_t i = 0; i < n && largest < 0.0; i++) a[v * n + i] = -a[v * n + i];
    }
    return true;
}
