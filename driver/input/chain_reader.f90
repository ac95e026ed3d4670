!> The group &chain of the input file.
module chain_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_settings, only : chain
    use namelist_input, only : above, at_least, between, namelist_file
    use slider_system, only : ends_fixed, ends_free, ends_periodic
    implicit none
    private

    public :: read_chain

    character(len=*), parameter :: group = 'chain'
    integer, parameter :: most_blocks = 1000000

contains

    !> Without the group: one block.
    subroutine read_chain(file, mass, blocks)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: mass      !! of a block [F T^2/L]
        type(chain), intent(out) :: blocks
        character(len=:), allocatable :: ends

        if (.not. file%has_group(group)) return
        call file%require(group, 'n_blocks')
        call file%get_integer(group, 'n_blocks', blocks%n_blocks, between(1.0_dp, &
            real(most_blocks, dp)), default=1)
        ! refused: rules about blocks are asked of a chain of a size that they can hold
        if (blocks%n_blocks < 1 .or. blocks%n_blocks > most_blocks) blocks%n_blocks = 2
        call file%get_real(group, 'coupling', blocks%coupling, at_least(0.0_dp))
        call file%get_choice(group, 'ends', ends, ['free    ', 'fixed   ', 'periodic'], &
            default='free')
        if (ends == 'fixed') blocks%ends = ends_fixed
        if (ends == 'periodic') blocks%ends = ends_periodic
        call file%get_real(group, 'scatter', blocks%scatter, between(0.0_dp, 0.99_dp), &
            default=0.0_dp)
        call file%get_real(group, 'displacement_scatter', blocks%displacement_scatter, &
            at_least(0.0_dp), default=0.0_dp)
        call file%get_integer(group, 'seed', blocks%seed, at_least(0.0_dp), default=1)
        if (file%given(group, 'slip_rate')) call file%get_real(group, 'slip_rate', &
            blocks%slip_rate, above(0.0_dp))
        if (blocks%displacement_scatter > 0.0_dp .and. mass <= 0.0_dp) call file%reject(group, &
            'displacement_scatter', 'must be 0 without a mass')
        if (blocks%n_blocks > 1 .and. mass <= 0.0_dp) call file%reject(group, 'n_blocks', &
            'must be 1 without a mass')
        if (blocks%n_blocks == 1 .and. blocks%ends == ends_periodic) blocks%ends = ends_free
    end subroutine read_chain

end module chain_reader
