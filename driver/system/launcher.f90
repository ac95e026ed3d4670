!> What a launcher of MPI has started.
module launcher
    implicit none
    private

    public :: is_companion

contains

    !> Has one started this process beside another that is the first? Their ways of telling so. Of
    !> what all of them would say the first one's words are enough.
    logical function is_companion() result(yes)
        character(len=*), parameter :: names(4) = [character(len=20) :: 'OMPI_COMM_WORLD_RANK', &
            'PMI_RANK', 'PMIX_RANK', 'SLURM_PROCID']
        character(len=12) :: rank
        integer :: i, status

        yes = .false.
        do i = 1, size(names)
            call get_environment_variable(trim(names(i)), rank, status=status)
            yes = yes .or. (status == 0 .and. rank /= '0')
        end do
    end function is_companion

end module launcher
