!> Faults of an input, of namelists and of tables alike: they are collected, each with its line, and
!> shown all at once.
module fault_list
    implicit none
    private

    public :: append_fault, fault

    type :: fault
        integer :: line = 0                     !! 0: of the file as a whole
        character(len=:), allocatable :: text
        logical :: hidden = .false.             !! follows from another fault
    end type fault

contains

    pure subroutine append_fault(list, line, text, hidden)
        type(fault), allocatable, intent(inout) :: list(:)
        integer, intent(in) :: line
        character(len=*), intent(in) :: text
        logical, intent(in), optional :: hidden
        type(fault) :: new

        new%line = line
        new%text = text
        if (present(hidden)) new%hidden = hidden
        list = [list, new]
    end subroutine append_fault

end module fault_list
