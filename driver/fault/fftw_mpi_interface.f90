!> FFTW's own Fortran interface for MPI.
module fftw_mpi
    use, intrinsic :: iso_c_binding
    implicit none
    public

    include 'fftw3-mpi.f03'

end module fftw_mpi
