!> FFTW's own Fortran interface.
module fftw
    use, intrinsic :: iso_c_binding
    implicit none
    public

    include 'fftw3.f03'

end module fftw
