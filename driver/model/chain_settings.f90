!> A chain of blocks: what couples them, in what they differ, and how their first places scatter.
module chain_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use archive_file, only : mix_text
    use slider_system, only : ends_free
    implicit none
    private

    public :: chain, displaced, load_factors, scatter_of_constant

    type :: chain
        integer :: n_blocks = 1
        real(dp) :: coupling = 0.0_dp    !! stiffness between neighbours [F/L]
        integer :: ends = ends_free
        real(dp) :: scatter = 0.0_dp     !! of the blocks' normal traction, relative [-]
        real(dp) :: displacement_scatter = 0.0_dp   !! of the blocks' places at the start [L]
        integer :: seed = 1
        real(dp) :: slip_rate = 0.0_dp   !! from which on slip belongs to an event [L/T]
        real(dp), allocatable :: load(:)   !! normal traction of each block by a profile, relative
                                           !! to their mean; 1 if not allocated [-]
        real(dp), allocatable :: constants(:, :)   !! of friction, one row a block, in the order of
                                                   !! `props`; not allocated: all have the same
    contains
        procedure :: loads_differ
    end type chain

contains

    pure logical function loads_differ(self) result(yes)
        class(chain), intent(in) :: self

        yes = self%scatter > 0.0_dp .or. allocated(self%load)
    end function loads_differ

    !> Factors of the blocks' normal traction: of the profile, and from 1 - scatter to 1 + scatter.
    pure function load_factors(blocks) result(factors)
        type(chain), intent(in) :: blocks
        real(dp), allocatable :: factors(:)   !! one a block [-]

        factors = 1.0_dp + blocks%scatter * random_numbers(blocks%seed, 0_int64, blocks%n_blocks)
        if (allocated(blocks%load)) factors = factors * blocks%load
    end function load_factors

    !> Factors of a constant of friction, from 1 - scatter to 1 + scatter. Each constant has random
    !> numbers of its own, whatever else scatters.
    pure function scatter_of_constant(blocks, name, scatter) result(factors)
        type(chain), intent(in) :: blocks
        character(len=*), intent(in) :: name   !! of the constant
        real(dp), intent(in) :: scatter        !! relative [-]
        real(dp) :: factors(blocks%n_blocks)   !! one a block [-]
        integer(int64) :: stream

        stream = 0
        call mix_text(name, stream)
        factors = 1.0_dp + scatter * random_numbers(blocks%seed, stream, blocks%n_blocks)
    end function scatter_of_constant

    !> What the blocks' places at the start differ from a common one.
    pure function displaced(blocks) result(by)
        type(chain), intent(in) :: blocks
        real(dp), allocatable :: by(:)        !! one a block [L]
        integer(int64), parameter :: stream = 1181783497276652981_int64   ! other than 0

        by = blocks%displacement_scatter * random_numbers(blocks%seed, stream, blocks%n_blocks)
    end function displaced

    !> Random numbers, even from -1 to 1, the same on every machine: Marsaglia's xorshift generator
    !> of 64 bits (J. Stat. Softw. 8(14), 2003), from a seed whose bits are mixed first.
    pure function random_numbers(seed, stream, n) result(numbers)
        integer, intent(in) :: seed              !! >= 0
        integer(int64), intent(in) :: stream     !! one of several sequences to a seed
        integer, intent(in) :: n
        real(dp) :: numbers(n)
        integer(int64), parameter :: origin = 88172645463325252_int64
        integer, parameter :: mixing_rounds = 64
        integer(int64) :: bits
        integer :: i

        bits = ieor(ieor(origin, stream), int(seed, int64))
        do i = 1, mixing_rounds
            bits = next_bits(bits)
        end do
        do i = 1, n
            bits = next_bits(bits)
            numbers(i) = 2.0_dp * scale(real(shiftr(bits, 11), dp), -53) - 1.0_dp
        end do
    end function random_numbers

    pure integer(int64) function next_bits(bits) result(next)
        integer(int64), intent(in) :: bits

        next = ieor(bits, shiftl(bits, 13))
        next = ieor(next, shiftr(next, 7))
        next = ieor(next, shiftl(next, 17))
    end function next_bits

end module chain_settings
