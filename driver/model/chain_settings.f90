!> A chain of blocks: what couples them, and how their strengths scatter.
module chain_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use slider_system, only : ends_free
    implicit none
    private

    public :: chain, scattered

    type :: chain
        integer :: n_blocks = 1
        real(dp) :: coupling = 0.0_dp    !! stiffness between neighbours [F/L]
        integer :: ends = ends_free
        real(dp) :: scatter = 0.0_dp     !! of the blocks' normal traction, relative [-]
        integer :: seed = 1
        real(dp) :: slip_rate = 0.0_dp   !! from which on slip belongs to an event [L/T]
    end type chain

contains

    !> Random numbers from 1 - scatter to 1 + scatter, the same on every machine: Marsaglia's
    !> xorshift generator of 64 bits (J. Stat. Softw. 8(14), 2003), from a seed whose
    !> bits are mixed first.
    pure function scattered(blocks) result(factors)
        type(chain), intent(in) :: blocks
        real(dp), allocatable :: factors(:)   !! one a block [-]
        integer(int64), parameter :: origin = 88172645463325252_int64
        integer, parameter :: mixing_rounds = 64
        integer(int64) :: bits
        integer :: i

        allocate (factors(blocks%n_blocks))
        bits = ieor(origin, int(blocks%seed, int64))
        do i = 1 - mixing_rounds, blocks%n_blocks
            bits = ieor(bits, shiftl(bits, 13))
            bits = ieor(bits, shiftr(bits, 7))
            bits = ieor(bits, shiftl(bits, 17))
            if (i > 0) factors(i) = 1.0_dp + blocks%scatter &
                * (2.0_dp * scale(real(shiftr(bits, 11), dp), -53) - 1.0_dp)
        end do
    end function scattered

end module chain_settings
