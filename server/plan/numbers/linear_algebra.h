/* The linear algebra that the planner needs, by LAPACK. Matrices are square, column after column. */
#ifndef LINEAR_ALGEBRA_H
#define LINEAR_ALGEBRA_H

#include <stdbool.h>
#include <stddef.h>

/* a (n,n), symmetric, its lower half given, becomes L with L L^T = a. False: it is not positive definite. */
bool cholesky_factor(size_t n, double *a);
/* b (n,count) becomes (L L^T)^-1 b. */
void cholesky_solve(size_t n, const double *l, size_t count, double *b);
/* b (n,count) becomes L^-1 b. */
void triangle_solve(size_t n, const double *l, size_t count, double *b);
/* l becomes the lower half of (L L^T)^-1. */
bool cholesky_invert(size_t n, double *l);
/* a (n,n), symmetric, becomes its eigenvectors, one a column, by growing eigenvalue. Of each the largest component is positive. */
bool symmetric_eigen(size_t n, double *a, double *values);

#endif
