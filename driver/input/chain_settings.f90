!> What the input file says about a chain of blocks: group &chain.
module chain_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use namelist_input, only : above, at_least, between, namelist_file
    use slider_system, only : ends_fixed, ends_free, ends_periodic
    implicit none
    private

    public :: chain, read_chain, scattered

    type :: chain
        integer :: n_blocks = 1
        real(dp) :: coupling = 0.0_dp    !! stiffness between neighbours [F/L]
        integer :: ends = ends_free
        real(dp) :: scatter = 0.0_dp     !! of the blocks' normal traction, relative [-]
        integer :: seed = 1
        real(dp) :: slip_rate = 0.0_dp   !! from which on slip belongs to an event [L/T]
    end type chain

    character(len=*), parameter :: group = 'chain'

contains

    !> Without the group: one block.
    subroutine read_chain(file, mass, blocks)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: mass      !! of a block [F T^2/L]
        type(chain), intent(out) :: blocks
        character(len=:), allocatable :: ends

        if (.not. file%has_group(group)) return
        if (.not. file%given(group, 'n_blocks')) call file%require(group, 'n_blocks')
        call file%get_integer(group, 'n_blocks', blocks%n_blocks, between(1.0_dp, 1.0e6_dp), &
            default=1)
        call file%get_real(group, 'coupling', blocks%coupling, at_least(0.0_dp))
        call file%get_choice(group, 'ends', ends, ['free    ', 'fixed   ', 'periodic'], &
            default='free')
        if (ends == 'fixed') blocks%ends = ends_fixed
        if (ends == 'periodic') blocks%ends = ends_periodic
        call file%get_real(group, 'scatter', blocks%scatter, between(0.0_dp, 0.99_dp), &
            default=0.0_dp)
        call file%get_integer(group, 'seed', blocks%seed, at_least(0.0_dp), default=1)
        if (file%given(group, 'slip_rate')) call file%get_real(group, 'slip_rate', &
            blocks%slip_rate, above(0.0_dp))
        if (blocks%n_blocks > 1 .and. mass <= 0.0_dp) call file%reject(group, 'n_blocks', &
            'must be 1 without a mass')
        if (blocks%n_blocks == 1 .and. blocks%ends == ends_periodic) blocks%ends = ends_free
    end subroutine read_chain

    !> Random numbers from 1 - scatter to 1 + scatter, the same on every machine: Marsaglia's
    !> xorshift generator of 64 bits (J. Stat. Softw. 8(14), 2003), from a seed that is stirred
    !> first.
    pure function scattered(blocks) result(factors)
        type(chain), intent(in) :: blocks
        real(dp), allocatable :: factors(:)   !! one a block [-]
        integer(int64), parameter :: origin = 88172645463325252_int64
        integer, parameter :: stirs = 64
        integer(int64) :: bits
        integer :: i

        allocate (factors(blocks%n_blocks))
        bits = ieor(origin, int(blocks%seed, int64))
        do i = 1 - stirs, blocks%n_blocks
            bits = ieor(bits, shiftl(bits, 13))
            bits = ieor(bits, shiftr(bits, 7))
            bits = ieor(bits, shiftl(bits, 17))
            if (i > 0) factors(i) = 1.0_dp + blocks%scatter &
                * (2.0_dp * scale(real(shiftr(bits, 11), dp), -53) - 1.0_dp)
        end do
    end function scattered

end module chain_settings
