!> The picture of a sweep, from its table: curves over one key, maps over two.
module sweep_picture
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use number_text, only : short_text, whole_text
    use picture, only : picture_values
    use sweep_settings, only : sweep_plan
    implicit none
    private

    public :: draw_sweep

contains

    !> DIRECTORY/STEM.png. `problem` says what went wrong.
    subroutine draw_sweep(plan, directory, stem, found, problem)
        type(sweep_plan), intent(in) :: plan
        character(len=*), intent(in) :: directory, stem
        integer, intent(in) :: found   !! combinations that stick and slip
        character(len=:), allocatable, intent(out) :: problem
        type(picture_values) :: values

        call values%begin(stem, stem // '.csv', plan%runs(1)%units)
        call values%set('found', found)
        call values%set('key_1', plan%axes(1)%name)
        if (size(plan%axes) == 1) then
            associate (x => plan%axes(1)%values)
                call values%set('over_decades', merge(1, 0, minval(x) > 0.0_dp .and. maxval(x) &
                    >= 10.0_dp * minval(x)))
                call values%set('lowest', minval(x))
                call values%set('highest', maxval(x))
            end associate
            call values%draw('sweep_curves', directory, stem, problem)
        else
            call values%set('key_2', plan%axes(2)%name)
            call values%set('right_cells', size(plan%axes(1)%values))
            call values%set('up_cells', size(plan%axes(2)%values))
            call values%set('tics_1', tics(plan%axes(1)%values))
            call values%set('tics_2', tics(plan%axes(2)%values))
            call values%draw('sweep_map', directory, stem, problem)
        end if
    end subroutine draw_sweep

    !> Labels of the places of the values; of many values every so many, so that they can be read.
    pure function tics(values) result(text)
        real(dp), intent(in) :: values(:)
        character(len=:), allocatable :: text
        integer, parameter :: most = 16
        integer :: i

        text = ''
        do i = 1, size(values), 1 + (size(values) - 1) / most
            if (i > 1) text = text // ', '
            text = text // '"' // short_text(values(i)) // '" ' // whole_text(i - 1)
        end do
    end function tics

end module sweep_picture
