!> The picture of a run of the fault, drawn by gnuplot from its tables.
module fault_picture
    use fault_settings, only : fault_plan
    use picture, only : picture_values
    implicit none
    private

    public :: draw_fault

contains

    !> DIRECTORY/STEM.png. `problem` says what went wrong.
    subroutine draw_fault(plan, directory, stem, problem)
        type(fault_plan), intent(in) :: plan
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        type(picture_values) :: values

        call values%begin(stem, stem // '_global.csv', plan%units)
        call values%set('contours', merge(stem // '_contours.csv', repeat(' ', len(stem) + 13), &
            plan%nx == 1 .and. plan%contours(1) > 0.0))
        call values%set('seismic_rate', plan%seismic_rate)
        call values%set('between', plan%contours(1))
        call values%set('during', plan%contours(2))
        call values%draw('fault', directory, stem, problem)
    end subroutine draw_fault

end module fault_picture
