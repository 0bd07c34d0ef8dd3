#pragma once

#include <Eigen/Dense>

/// Eigen's products and decompositions of matrices of any size, compiled once (src/support/dense.cpp) in place of once
/// in every source that multiplies or factorises. Include this where one of them is used; <Eigen/Core> is enough for a
/// declaration. To the compiler it says "found elsewhere" and nothing else: leaving it out is slower to build, not
/// wrong.
#define POSEWRIGHT_DENSE_INSTANCES(EXTERN)                                                                             \
  namespace Eigen {                                                                                                    \
  namespace internal {                                                                                                 \
  using PosewrightColumns = blas_data_mapper<double, Index, ColMajor>;                                                 \
  using PosewrightRows = blas_data_mapper<double, Index, RowMajor>;                                                    \
  using PosewrightConstColumns = const_blas_data_mapper<double, Index, ColMajor>;                                      \
  using PosewrightConstRows = const_blas_data_mapper<double, Index, RowMajor>;                                         \
  using PosewrightGebp = gebp_traits<double, double>;                                                                  \
  EXTERN template struct gebp_kernel<double, double, Index, PosewrightColumns, PosewrightGebp::mr, PosewrightGebp::nr, \
                                     false, false>;                                                                    \
  EXTERN template struct gemm_pack_lhs<double, Index, PosewrightConstColumns, PosewrightGebp::mr,                      \
                                       PosewrightGebp::LhsProgress, PosewrightGebp::LhsPacket4Packing, ColMajor>;      \
  EXTERN template struct gemm_pack_lhs<double, Index, PosewrightConstRows, PosewrightGebp::mr,                         \
                                       PosewrightGebp::LhsProgress, PosewrightGebp::LhsPacket4Packing, RowMajor>;      \
  EXTERN template struct gemm_pack_rhs<double, Index, PosewrightConstColumns, PosewrightGebp::nr, ColMajor>;           \
  EXTERN template struct gemm_pack_rhs<double, Index, PosewrightConstRows, PosewrightGebp::nr, RowMajor>;              \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstColumns, ColMajor, false, double, \
                                                       PosewrightConstColumns, false>;                                 \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstColumns, ColMajor, false, double, \
                                                       PosewrightConstRows, false>;                                    \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstRows, RowMajor, false, double,    \
                                                       PosewrightConstColumns, false>;                                 \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstRows, RowMajor, false, double,    \
                                                       PosewrightConstRows, false>;                                    \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;       \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;       \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, RowMajor, ColMajor, 1>;       \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor, ColMajor, 1>;       \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor, ColMajor, 1>;      \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, ColMajor, ColMajor, 1>;      \
  EXTERN template struct triangular_solve_matrix<double, Index, OnTheRight, Lower, false, RowMajor, ColMajor, 1>;      \
  EXTERN template struct product_triangular_matrix_matrix<double, Index, Upper, true, RowMajor, false, ColMajor,       \
                                                          false, ColMajor, 1, 0>;                                      \
  EXTERN template struct product_triangular_matrix_matrix<double, Index, Lower, true, ColMajor, false, ColMajor,       \
                                                          false, ColMajor, 1, 0>;                                      \
  EXTERN template struct product_triangular_matrix_matrix<double, Index, UnitUpper, true, RowMajor, false, ColMajor,   \
                                                          false, ColMajor, 1, 0>;                                      \
  EXTERN template struct product_triangular_matrix_matrix<double, Index, UnitLower, true, ColMajor, false, ColMajor,   \
                                                          false, ColMajor, 1, 0>;                                      \
  EXTERN template Index llt_inplace<double, Lower>::unblocked<MatrixXd>(MatrixXd&);                                    \
  EXTERN template Index llt_inplace<double, Lower>::unblocked<Block<MatrixXd>>(Block<MatrixXd>&);                      \
  EXTERN template Index llt_inplace<double, Lower>::blocked<MatrixXd>(MatrixXd&);                                      \
  EXTERN template void tridiagonalization_inplace<MatrixXd, VectorXd>(MatrixXd&, VectorXd&);                           \
  EXTERN template ComputationInfo computeFromTridiagonal_impl<MatrixXd, VectorXd, VectorXd>(VectorXd&, VectorXd&,      \
                                                                                            const Index, bool,         \
                                                                                            MatrixXd&);                \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstColumns, ColMajor, false, double, \
                                                       PosewrightConstColumns, false, BuiltIn>;                        \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstColumns, ColMajor, false, double, \
                                                       PosewrightConstRows, false, BuiltIn>;                           \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstRows, RowMajor, false, double,    \
                                                       PosewrightConstColumns, false, BuiltIn>;                        \
  EXTERN template struct general_matrix_vector_product<Index, double, PosewrightConstRows, RowMajor, false, double,    \
                                                       PosewrightConstRows, false, BuiltIn>;                           \
  EXTERN template void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&, Index&, Index); \
  EXTERN template void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&, Index&, Index); \
  }                                                                                                                    \
  EXTERN template class LLT<MatrixXd>;                                                                                 \
  EXTERN template class LDLT<MatrixXd>;                                                                                \
  EXTERN template class HouseholderQR<MatrixXd>;                                                                       \
  EXTERN template class ColPivHouseholderQR<MatrixXd>;                                                                 \
  EXTERN template class CompleteOrthogonalDecomposition<MatrixXd>;                                                     \
  EXTERN template class SelfAdjointEigenSolver<MatrixXd>;                                                              \
  EXTERN template class JacobiSVD<MatrixXd>;                                                                           \
  EXTERN template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);                                   \
  EXTERN template void LLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;                                   \
  EXTERN template void LLT<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;                                   \
  EXTERN template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);                                 \
  EXTERN template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(                         \
      const EigenBase<MatrixXd>&, int);                                                                                \
  }
POSEWRIGHT_DENSE_INSTANCES(extern)
